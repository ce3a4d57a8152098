// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/requests.hpp"

#include <set>
#include <variant>

#include "errors/errors.hpp"
#include "records/job_record.hpp"
#include "records/mesh_record.hpp"
#include "store/files.hpp"

namespace anticrack::store {

std::vector<std::string> uploads_of(const records::JobSpec& spec) {
  std::set<std::string> uploads;
  for (const fem::Load& load : spec.loads)
    if (const auto* array = std::get_if<fem::Array>(&load.force)) uploads.insert(array->upload);
  if (spec.sweep) uploads.insert(spec.sweep->upload);
  return {uploads.begin(), uploads.end()};
}

std::string upload_of(const records::MeshRecord& record) {
  const auto* upload = std::get_if<records::UploadRef>(&record.definition);
  return upload == nullptr ? std::string() : upload->sha256;
}

void require_same_request(const std::string& request_id, const std::string& id,
                          const std::string& its_fingerprint, const std::string& fingerprint) {
  if (its_fingerprint == fingerprint) return;
  throw errors::Error(errors::Reason::request_id_reused,
                      "request id \"{}\" was used for jobs/{}, which is another job: make a new "
                      "request id for each job",
                      request_id, id)
      .at("request_id");
}

void require_triangulation(const records::MeshRecord& record, std::span<const std::byte> encoded) {
  if (sha256_of(encoded) != record.sha256)
    throw errors::Error(errors::Reason::internal, "meshes/{} comes with another triangulation",
                        record.id);
}

errors::Error unknown(const std::string& collection, const std::string& id) {
  return {errors::Reason::not_found, "there is no " + collection + "/" + id};
}

errors::Error upload_in_use(const std::string& sha256) {
  return {errors::Reason::in_use,
          "uploads/{} is needed by a job that has not ended or a mesh that is not meshed: delete "
          "it later, or cancel the job or delete the mesh first",
          sha256};
}

}  // namespace anticrack::store
