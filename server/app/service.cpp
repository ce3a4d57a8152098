// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/service.hpp"

#include <unistd.h>

#include <algorithm>
#include <utility>

#include "app/data_folder.hpp"
#include "app/listen_address.hpp"
#include "jobs/job_engine.hpp"
#include "meshes/mesh_catalogue.hpp"
#include "operators/mesh_operator.hpp"
#include "operators/operator_cache.hpp"
#include "rpc/server.hpp"
#include "store/store.hpp"

namespace anticrack::app {
namespace {

meshes::CatalogueOptions catalogue_options(const Config& config) {
  meshes::CatalogueOptions options;
  options.helper.executable = config.mesher.empty() ? mesher::default_executable() : config.mesher;
  options.helper.time_limit = std::chrono::ceil<std::chrono::seconds>(config.meshing_time);
  options.helper.memory_limit = config.mesher_memory;
  options.max_triangles = config.mesh_triangles;
  options.max_pending = static_cast<std::size_t>(config.pending_meshes);
  if (::access(options.helper.executable.c_str(), X_OK) != 0) {
    throw ConfigError("mesher: " + options.helper.executable +
                      " is no program; say where anticrack-mesher is with --mesher PATH");
  }
  return options;
}

jobs::EngineOptions engine_options(const Config& config) {
  jobs::EngineOptions options;
  options.threads = config.threads;
  options.max_load_cases = config.load_cases;
  options.max_iterations = config.iterations;
  options.max_expression_bytes = static_cast<std::size_t>(config.expression_bytes);
  options.max_queued_jobs = config.queued_jobs;
  options.max_kept_jobs = config.kept_jobs;
  options.max_kept_bytes = config.kept_bytes;
  options.event_log_bytes = config.event_log;
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
  return options;
}

operators::OperatorCache::Factorise factorise(const Config& config) {
  const int threads = std::min(config.threads, 2);  // one for each subdomain
  return [threads](std::shared_ptr<const mesh::Mesh> mesh, std::stop_token stop) {
    return operators::MeshOperator::factorise(std::move(mesh), threads, std::move(stop));
  };
}

}  // namespace

struct Service::Parts {
  explicit Parts(const Config& config)
      : address(parse_listen_address(config.listen)),
        drain_time(config.drain_time),
        folder(config.data_dir),
        store(store::make_memory_store(config.data_dir)),
        cache(config.memory_budget, factorise(config)),
        catalogue(catalogue_options(config), *store, cache),
        engine(engine_options(config), *store, catalogue) {
    clear_stale_socket(address);
    server = std::make_unique<rpc::Server>(server_options(config),
                                           rpc::Backend{engine, catalogue, cache, *store});
  }

  ListenAddress address;
  std::chrono::milliseconds drain_time;
  DataFolder folder;
  std::unique_ptr<store::Store> store;
  operators::OperatorCache cache;
  meshes::MeshCatalogue catalogue;
  jobs::JobEngine engine;
  std::unique_ptr<rpc::Server> server;
};

Service::Service(const Config& config) {
  operators::require_threadsafe_blas();
  _parts = std::make_unique<Parts>(config);
}

Service::~Service() {
  _parts->server.reset();
  if (!_parts->address.socket_path.empty()) ::unlink(_parts->address.socket_path.c_str());
}

const std::string& Service::address() const noexcept {
  return _parts->server->address();
}

void Service::drain() {
  _parts->server->drain(_parts->drain_time);
}

}  // namespace anticrack::app
