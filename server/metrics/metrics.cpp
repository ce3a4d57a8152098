// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/metrics.hpp"

#include <prometheus/collectable.h>
#include <prometheus/exposer.h>

#include <iterator>
#include <mutex>
#include <utility>
#include <vector>

#include "errors/errors.hpp"
#include "metrics/families.hpp"
#include "metrics/pulled.hpp"

namespace anticrack::metrics {
namespace {

double seconds_since_1970() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// Reads the snapshot at each scrape.
class Pulled : public prometheus::Collectable {
 public:
  Pulled(double started, std::function<Snapshot()> read)
      : _started(started), _read(std::move(read)) {}

  /// Under C code of the HTTP server, which no exception may pass: then those families are missing,
  /// and an alert on their absence tells.
  std::vector<prometheus::MetricFamily> Collect() const override {
    std::vector<prometheus::MetricFamily> families;
    try {
      families = process_families(_started);
      std::vector<prometheus::MetricFamily> more = server_families(_read());
      std::move(more.begin(), more.end(), std::back_inserter(families));
    } catch (const std::exception&) {
    }
    return families;
  }

 private:
  double _started;
  std::function<Snapshot()> _read;
};

/// What counts must never be the reason that something else fails.
template <class Action>
void quietly(const Action& action) noexcept {
  try {
    action();
  } catch (...) {
  }
}

}  // namespace

struct Metrics::State {
  State(const std::string& version, const std::string& build) : families(version, build) {}

  const double started = seconds_since_1970();
  Families families;
  std::mutex mutex;  ///< of what follows
  std::shared_ptr<Pulled> pulled;
  std::unique_ptr<prometheus::Exposer> exposer;
};

Metrics::Metrics(const std::string& version, const std::string& build)
    : _state(std::make_unique<State>(version, build)) {}

Metrics::~Metrics() {
  stop();
}

void Metrics::call_ended(const std::string& method, int code,
                         std::chrono::duration<double> time) noexcept {
  quietly([&] { _state->families.call_ended(method, code, time); });
}

void Metrics::job_ended(const store::JobRecord& job) noexcept {
  quietly([&] { _state->families.job_ended(job); });
}

void Metrics::meshed(const store::MeshRecord& mesh) noexcept {
  quietly([&] { _state->families.meshed(mesh); });
}

void Metrics::factorised(std::chrono::duration<double> time) noexcept {
  quietly([&] { _state->families.factorised(time); });
}

std::string Metrics::listen(const std::string& address, std::function<Snapshot()> read) {
  const std::size_t colon = address.rfind(':');
  // The HTTP library would take a comma for a second address.
  if (colon == std::string::npos || address.find_first_of(", ") != std::string::npos) {
    throw errors::Error(errors::Reason::invalid_argument,
                        "\"" + address + "\" is not HOST:PORT to serve metrics on")
        .at("metrics-listen");
  }
  const std::lock_guard lock(_state->mutex);
  try {
    // Whoever sends nothing holds one of two threads, so not for long.
    _state->exposer = std::make_unique<prometheus::Exposer>(std::vector<std::string>{
        "listening_ports", address, "num_threads", "2", "request_timeout_ms", "5000"});
  } catch (const std::exception& problem) {
    throw errors::Error(errors::Reason::invalid_argument,
                        "cannot serve metrics on " + address +
                            "; is the port taken, or the address another machine's? (" +
                            problem.what() + ")")
        .at("metrics-listen");
  }
  _state->pulled = std::make_shared<Pulled>(_state->started, std::move(read));
  _state->exposer->RegisterCollectable(_state->families.registry());
  _state->exposer->RegisterCollectable(_state->pulled);
  return address.substr(0, colon + 1) + std::to_string(_state->exposer->GetListeningPorts().at(0));
}

void Metrics::stop() {
  const std::lock_guard lock(_state->mutex);
  _state->exposer.reset();  // joins its threads
  _state->pulled.reset();
}

}  // namespace anticrack::metrics
