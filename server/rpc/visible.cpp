// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/visible.hpp"

#include "api/names.hpp"
#include "errors/errors.hpp"
#include "jobs/job_engine.hpp"
#include "meshes/mesh_catalogue.hpp"
#include "records/job_record.hpp"
#include "records/mesh_record.hpp"

namespace anticrack::rpc {
namespace {

using errors::Error;
using errors::Reason;

template <class Get>
auto visible(const access::Identity& who, const std::string& name, Get get) {
  try {
    auto record = get();
    if (access::may_see(who, record.owner)) return record;
  } catch (const Error& error) {
    if (error.reason() != Reason::not_found) throw;
  }
  throw Error(Reason::not_found, "there is no {}", name);
}

}  // namespace

records::MeshRecord visible_mesh(const Backend& backend, const access::Identity& who,
                                 const std::string& id) {
  return visible(who, api::mesh_name(id), [&] { return backend.catalogue.get(id); });
}

records::JobRecord visible_job(const Backend& backend, const access::Identity& who,
                               const std::string& id) {
  return visible(who, api::job_name(id), [&] { return backend.engine.get(id); });
}

std::optional<std::string> owner_filter(const access::Identity& who, const std::string& owner) {
  if (owner.empty() && who.role == access::Role::admin) return std::nullopt;
  if (owner.empty() || owner == who.name) return who.name;
  access::require_admin(who, "list what belongs to others");
  return owner;
}

}  // namespace anticrack::rpc
