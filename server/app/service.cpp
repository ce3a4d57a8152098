// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/service.hpp"

#include <unistd.h>

#include <atomic>
#include <exception>
#include <thread>
#include <utility>

#include "app/data_folder.hpp"
#include "app/events.hpp"
#include "app/listen_address.hpp"
#include "app/machine.hpp"
#include "app/options.hpp"
#include "app/security.hpp"
#include "group/store.hpp"
#include "log/log.hpp"
#include "metrics/metrics.hpp"
#include "operators/mesh_operator.hpp"
#include "rpc/version.hpp"

namespace anticrack::app {

namespace {

/// Warns if the memory limits are too low, as the kernel kills a process that takes more.
void warn_of_memory(const Config& config) {
  const Machine machine = this_machine();
  if (config.limits.memory_budget_bytes <= machine.memory_bytes) return;
  log::warn("memory", {{"warning", "memory-budget is more than there is; give less"},
                       {"memory_budget_bytes", config.limits.memory_budget_bytes},
                       {"bytes", machine.memory_bytes},
                       {"limited_by", machine.memory_limit}});
}

}  // namespace

struct Service::Parts {
  explicit Parts(const Config& config)
      : given(config),
        address(parse_listen_address(config.listen)),
        drain_delay(config.drain_delay),
        drain_time(config.drain_time),
        metrics(rpc::version(), rpc::build()),
        folder(config.store.folder),
        store(config.store.url.empty()
                  ? store::open(config.store)
                  : std::make_unique<group::Store>(config.store)),
        cache(config.limits.memory_budget_bytes, factorise_function(config),
              [this](std::chrono::duration<double> time) { factorised(metrics, time); }),
        catalogue(with_listener(catalogue_options(config)), *store, cache),
        engine(with_listener(config.jobs), *store, catalogue) {}

  void listen(const Config& config, rpc::Security security) {
    clear_stale_socket(address);
    rpc::ServerOptions options = server_options(config);
    options.security = std::move(security);
    options.call_ended = [this](const std::string& method, int code,
                                std::chrono::duration<double> time) {
      metrics.call_ended(method, code, time);
    };
    server = std::make_unique<rpc::Server>(options, rpc::Backend{engine, catalogue, cache, *store});
    ready = true;
    if (config.metrics_listen.empty()) return;
    const std::string where = metrics.listen(config.metrics_listen, [this] { return page(); });
    log::info("metrics", {{"url", "http://" + where + "/metrics"}});
  }

  metrics::Snapshot page() const {
    metrics::Snapshot now = snapshot();
    now.owners = store->owners();
    return now;
  }

  metrics::Snapshot snapshot() const {
    const rpc::Server::Metrics calls = server->metrics();
    metrics::Snapshot now;
    now.engine = engine.metrics();
    now.cache = cache.metrics();
    now.disk = store->usage();
    now.meshings = catalogue.meshings();
    now.pending_meshes = catalogue.pending();
    now.connections = calls.connections;
    now.connections_limit = given.limits.connections;
    now.connections_accepted = calls.connections_accepted;
    now.connections_refused = calls.connections_refused;
    now.watchers = calls.watchers;
    now.transfers = calls.transfers;
    now.largest_lag = calls.largest_lag;
    now.ready = ready;
    return now;
  }

  meshes::CatalogueOptions with_listener(meshes::CatalogueOptions options) {
    options.meshed = [this](const records::MeshRecord& mesh) { meshed(metrics, mesh); };
    return options;
  }

  jobs::EngineOptions with_listener(jobs::EngineOptions options) {
    options.ended = [this](const records::JobRecord& job) { job_ended(metrics, job); };
    return options;
  }

  const Config given;
  ListenAddress address;
  std::chrono::milliseconds drain_delay;
  std::chrono::milliseconds drain_time;
  std::atomic<bool> ready{false};
  metrics::Metrics metrics;
  DataFolder folder;
  std::unique_ptr<store::Store> store;
  operators::OperatorCache cache;
  meshes::MeshCatalogue catalogue;
  jobs::JobEngine engine;
  std::unique_ptr<rpc::Server> server;
};

Service::Service(const Config& config) {
  operators::require_threadsafe_blas();
  LoadedSecurity access = load_security(config);
  for (const std::string& warning : access.warnings) log::warn("security", {{"warning", warning}});
  warn_of_memory(config);
  _parts = std::make_unique<Parts>(config);
  _parts->listen(config, std::move(access.security));
}

Service::~Service() {
  _parts->metrics.stop();
  _parts->server.reset();
  if (!_parts->address.socket_path.empty()) ::unlink(_parts->address.socket_path.c_str());
}

const std::string& Service::address() const noexcept { return _parts->server->address(); }

void Service::check_alive() const noexcept {
  try {
    _parts->snapshot();
  } catch (const std::exception&) {
    // An error shows that nothing is stuck, and a bad disk must not get the process killed.
  }
}

void Service::reload() noexcept {
  try {
    const LoadedSecurity access = load_security(_parts->given);
    _parts->server->replace(access.security);
    for (const std::string& warning : access.warnings)
      log::warn("security", {{"warning", warning}});
    log::info("read again", {{"files", "certificates, key and tokens, where the server has any"}});
  } catch (const std::exception& error) {
    log::error("not read again",
               {{"message", error.what()}, {"kept", "the certificates, key and tokens in use"}});
  }
}

void Service::drain() {
  _parts->ready = false;
  _parts->server->announce_stop();
  std::this_thread::sleep_for(_parts->drain_delay);
  _parts->server->drain(_parts->drain_time);
  _parts->engine.stop(std::chrono::milliseconds(0));
}

}  // namespace anticrack::app
