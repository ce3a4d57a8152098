// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/options.hpp"

#include <unistd.h>

#include <algorithm>
#include <utility>

#include "operators/mesh_operator.hpp"

namespace anticrack::app {

meshes::CatalogueOptions catalogue_options(const Config& config) {
  meshes::CatalogueOptions options = config.meshes;
  options.max_expression_bytes = config.jobs.max_expression_bytes;
  mesher::HelperOptions& helper = options.helper;
  helper.time_limit = std::chrono::ceil<std::chrono::seconds>(config.meshing_time);
  if (helper.executable.empty()) helper.executable = mesher::default_executable();
  if (::access(helper.executable.c_str(), X_OK) != 0) {
    throw ConfigError("mesher: " + helper.executable +
                      " is not a program; give the path of anticrack-mesher with --mesher PATH");
  }
  return options;
}

void require_mesher(const Config& config) {
  const std::string path = catalogue_options(config).helper.executable;
  if (mesher::is_helper(path)) return;
  throw ConfigError("mesher: " + path +
                    " is not the anticrack-mesher of this version; install it with the server, or "
                    "give its path with --mesher PATH");
}

rpc::ServerOptions server_options(const Config& config) {
  rpc::ServerOptions options;
  options.listen = config.listen;
  options.limits = config.limits;
  options.limits.mesh_triangles = config.meshes.max_triangles;
  options.limits.meshes = config.meshes.max_meshes;
  options.limits.pending_meshes = config.meshes.max_pending;
  options.limits.disk_budget_bytes = config.store.disk_budget;
  options.limits.mesher_memory_bytes = config.meshes.helper.memory_limit;
  options.limits.meshing_time = std::chrono::ceil<std::chrono::seconds>(config.meshing_time);
  return options;
}

operators::OperatorCache::Factorise factorise_function(const Config& config) {
  const int threads = std::min(config.jobs.threads, 2);  // one for each subdomain
  return [threads](std::shared_ptr<const mesh::Mesh> mesh, std::stop_token stop) {
    return operators::MeshOperator::factorise(std::move(mesh), threads, std::move(stop));
  };
}

}  // namespace anticrack::app
