// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/metrics.hpp"

#include <prometheus/text_serializer.h>

#include <iterator>
#include <mutex>
#include <utility>
#include <vector>

#include "errors/errors.hpp"
#include "metrics/families.hpp"
#include "metrics/http_page.hpp"
#include "metrics/pulled.hpp"

namespace anticrack::metrics {
namespace {

double seconds_since_1970() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

void append(std::vector<prometheus::MetricFamily>& all,
            std::vector<prometheus::MetricFamily> more) {
  std::move(more.begin(), more.end(), std::back_inserter(all));
}

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

  /// What cannot be read is left out, and an alert on its absence tells.
  std::string page(const std::function<Snapshot()>& read) const noexcept {
    std::vector<prometheus::MetricFamily> all;
    quietly([&] {
      append(all, families.registry()->Collect());
      append(all, process_families(started));
      append(all, server_families(read()));
    });
    std::string text;
    quietly([&] { text = prometheus::TextSerializer().Serialize(all); });
    return text;
  }

  const double started = seconds_since_1970();
  Families families;
  std::mutex mutex;  ///< of what follows
  std::unique_ptr<HttpPage> http;
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
  const std::lock_guard lock(_state->mutex);
  try {
    _state->http = std::make_unique<HttpPage>(
        address, "/metrics", "text/plain; version=0.0.4; charset=utf-8",
        [state = _state.get(), read = std::move(read)] { return state->page(read); });
  } catch (const std::exception& problem) {
    throw errors::Error(
        errors::Reason::invalid_argument,
        "cannot serve metrics on " + address + ": " + problem.what() + "; give another HOST:PORT")
        .at("metrics-listen");
  }
  return _state->http->address();
}

void Metrics::stop() {
  const std::lock_guard lock(_state->mutex);
  _state->http.reset();
}

}  // namespace anticrack::metrics
