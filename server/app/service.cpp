// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/service.hpp"

#include <unistd.h>

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stop_token>
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

/// How long the store may be out of reach before clients are sent elsewhere.
constexpr std::chrono::seconds patience_with_store{5};

std::unique_ptr<store::Store> open_store(const store::StoreOptions& options) {
  if (options.url.empty()) return store::open(options);
  try {
    return std::make_unique<group::Store>(options);
  } catch (const errors::Error& error) {
    if (error.reason() != errors::Reason::invalid_argument) throw;
    throw ConfigError(std::string("store: ") + error.what());
  }
}

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
        store(open_store(with_listener(config.store))),
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
    if (!config.store.url.empty())
      watcher = std::jthread([this](const std::stop_token& stop) { watch_store(stop); });
    if (config.metrics_listen.empty()) return;
    const std::string where = metrics.listen(
        config.metrics_listen, [this] { return page(); }, [this] { return ready.load(); });
    log::info("metrics", {{"url", "http://" + where + "/metrics"}});
  }

  /// Tells balancers when the store has been out of reach for too long, and when it is back.
  void watch_store(const std::stop_token& stop) {
    std::mutex mutex;
    std::condition_variable_any stopped;
    std::uint64_t lost = 0;
    std::unique_lock lock(mutex);
    while (!stopped.wait_for(lock, stop, std::chrono::milliseconds(500),
                             [&] { return stop.stop_requested(); })) {
      if (std::exchange(lost, engine.metrics().leases_lost) < lost)
        log::warn("lease lost", {{"because", "it was paused, or cut off from the database"},
                                 {"so", "others may have its jobs, which it has dropped"}});
      const bool usable = store->unreachable() < patience_with_store;
      if (usable == ready) continue;
      ready = usable;
      server->announce(usable);
      if (usable)
        log::info("store", {{"reached", "again"}});
      else
        log::error("store", {{"out_of_reach_for_s", patience_with_store.count()},
                             {"cure", "check that PostgreSQL runs and can be reached from here"}});
    }
  }

  metrics::Snapshot page() const {
    metrics::Snapshot now = snapshot();
    if (store_answers()) {
      now.owners = store->owners();
      now.group = store->group();
    }
    now.store_unreachable = store->unreachable();
    return now;
  }

  /// One that does not would make who asks wait, and readiness unknown.
  bool store_answers() const { return store->unreachable().count() == 0; }

  metrics::Snapshot snapshot() const {
    const rpc::Server::Metrics calls = server->metrics();
    metrics::Snapshot now;
    now.engine = engine.metrics();
    now.cache = cache.metrics();
    if (store_answers()) now.disk = store->usage();
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

  store::StoreOptions with_listener(store::StoreOptions options) {
    options.answered = [this](std::chrono::duration<double> time) { metrics.store_answered(time); };
    return options;
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
  std::jthread watcher;
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
  _parts->watcher = {};
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
  _parts->watcher = {};
  _parts->ready = false;
  _parts->server->announce(false);
  std::this_thread::sleep_for(_parts->drain_delay);
  _parts->server->drain(_parts->drain_time);
  _parts->engine.stop(std::chrono::milliseconds(0));
}

}  // namespace anticrack::app
