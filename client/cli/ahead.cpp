// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/ahead.hpp"

#include <exception>

#include "cli/to_result.hpp"
#include "client/jobs.hpp"
#include "client/meshes.hpp"

namespace anticrack::cli {
namespace {

std::shared_ptr<Ahead> fetch_now(Session& session, const std::string& mesh) {
  auto ahead = std::make_shared<Ahead>();
  client::Connection& connection = session.connection();
  const std::stop_token stop = session.stop();
  ahead->mesh = client::get_mesh(connection, mesh, stop);
  if (ahead->mesh.state() != v1::Mesh::STATE_READY) return nullptr;
  ahead->server = client::server_info(connection, stop);
  ahead->mesh_block = client::read_mesh(connection, mesh, stop);
  ahead->compressed = results::compress(to_mesh_plan(ahead->mesh, ahead->mesh_block).mesh);
  return ahead;
}

}  // namespace

AheadFuture fetch_ahead(Session& session, const std::string& mesh) {
  return std::async(std::launch::async,
                    [&session, mesh]() -> std::shared_ptr<Ahead> {
                      try {
                        return fetch_now(session, mesh);
                      } catch (const std::exception&) {
                        return nullptr;
                      }
                    })
      .share();
}

}  // namespace anticrack::cli
