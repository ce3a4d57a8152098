// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/options.hpp"

#include <unistd.h>

#include <algorithm>
#include <utility>

#include "operators/mesh_operator.hpp"

namespace anticrack::app {

store::StoreOptions store_options(const Config& config) {
  return {config.data_dir, config.disk_budget};
}

meshes::CatalogueOptions catalogue_options(const Config& config) {
  meshes::CatalogueOptions options;
  options.helper.executable = config.mesher.empty() ? mesher::default_executable() : config.mesher;
  options.helper.time_limit = std::chrono::ceil<std::chrono::seconds>(config.meshing_time);
  options.helper.memory_limit = config.mesher_memory;
  options.max_triangles = config.mesh_triangles;
  options.max_pending = static_cast<std::size_t>(config.pending_meshes);
  options.max_meshes = static_cast<std::size_t>(config.kept_meshes);
  if (::access(options.helper.executable.c_str(), X_OK) != 0) {
    throw ConfigError("mesher: " + options.helper.executable +
                      " is not a program; give the path of anticrack-mesher with --mesher PATH");
  }
  return options;
}

jobs::EngineOptions engine_options(const Config& config) {
  jobs::EngineOptions options;
  options.threads = config.threads;
  options.columns = config.columns;
  options.max_load_cases = config.load_cases;
  options.max_sweep_rows = config.max_sweep_rows;
  options.max_sweep_basis = config.max_sweep_basis;
  options.max_iterations = config.iterations;
  options.max_expression_bytes = static_cast<std::size_t>(config.expression_bytes);
  options.max_queued_jobs = config.queued_jobs;
  options.max_crashes = config.crashes;
  options.max_queued_cases = config.queued_cases;
  options.max_queued_bytes = config.queued_bytes;
  options.queue_time = config.queue_time;
  options.run_time = config.run_time;
  options.event_log_bytes = config.event_log;
  options.max_result_bytes = config.result_limit;
  options.max_kept_jobs = config.kept_jobs;
  options.result_ttl = config.result_ttl;
  options.result_budget = config.result_budget;
  options.upload_ttl = config.upload_ttl;
  return options;
}

rpc::ServerOptions server_options(const Config& config) {
  rpc::ServerOptions options;
  options.listen = config.listen;
  options.limits.upload_bytes = config.upload_limit;
  options.limits.mesh_triangles = config.mesh_triangles;
  options.limits.memory_budget_bytes = config.memory_budget;
  options.limits.meshing_time = std::chrono::ceil<std::chrono::seconds>(config.meshing_time);
  options.limits.watchers = config.watchers;
  options.limits.transfers = config.transfers;
  options.limits.streams_a_client = config.streams_a_client;
  return options;
}

operators::OperatorCache::Factorise factorise_function(const Config& config) {
  const int threads = std::min(config.threads, 2);  // one for each subdomain
  return [threads](std::shared_ptr<const mesh::Mesh> mesh, std::stop_token stop) {
    return operators::MeshOperator::factorise(std::move(mesh), threads, std::move(stop));
  };
}

}  // namespace anticrack::app
