// SPDX-License-Identifier: GPL-3.0-or-later
//
// The table of keys.
#include <algorithm>
#include <array>
#include <utility>

#include "app/config.hpp"
#include "app/listen_address.hpp"
#include "app/nearest.hpp"
#include "app/values.hpp"

namespace anticrack::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// Empty: as if it were not there; the help says what that means.
Key text(std::string name, std::string placeholder, std::string help, std::string Config::*field) {
  return {std::move(name),
          KeyType::text,
          std::move(placeholder),
          std::move(help),
          [field](Config& config, const std::string& value) { config.*field = value; },
          [field](const Config& config) { return config.*field; }};
}

Key word(std::string name, std::string help, std::vector<std::string> known,
         std::string Config::*field) {
  return {std::move(name),
          KeyType::text,
          "WORD",
          std::move(help),
          [field, known = std::move(known)](Config& config, const std::string& value) {
            if (std::find(known.begin(), known.end(), value) == known.end()) {
              throw std::invalid_argument(std::string("\"") + value +
                                          "\" is none of the words for it; did you mean \"" +
                                          nearest(value, known) + "\"?");
            }
            config.*field = value;
          },
          [field](const Config& config) { return config.*field; }};
}

Key bytes(std::string name, std::string help, std::uint64_t Config::*field, std::uint64_t least) {
  return {std::move(name),
          KeyType::number,
          "BYTES",
          std::move(help),
          [field, least](Config& config, const std::string& value) {
            const std::uint64_t amount = to_bytes(value);
            if (amount < least) {
              throw std::invalid_argument(std::string("\"") + value +
                                          "\" is too small; give at least " + from_bytes(least));
            }
            config.*field = amount;
          },
          [field](const Config& config) { return from_bytes(config.*field); }};
}

template <class Integer>
Key count(std::string name, std::string help, Integer Config::*field, std::int64_t least,
          std::int64_t most) {
  return {std::move(name),
          KeyType::number,
          "N",
          std::move(help),
          [field, least, most](Config& config, const std::string& value) {
            config.*field = static_cast<Integer>(to_integer(value, least, most));
          },
          [field](const Config& config) { return std::to_string(config.*field); }};
}

Key time(std::string name, std::string help, milliseconds Config::*field,
         milliseconds least = milliseconds(0)) {
  return {std::move(name),
          KeyType::number,
          "TIME",
          std::move(help),
          [field, least](Config& config, const std::string& value) {
            const milliseconds amount = to_time(value);
            if (amount < least) {
              throw std::invalid_argument(std::string("\"") + value +
                                          "\" is too short; give at least " + from_time(least));
            }
            config.*field = amount;
          },
          [field](const Config& config) { return from_time(config.*field); }};
}

Key flag(std::string name, std::string help, bool Config::*field) {
  return {std::move(name),
          KeyType::flag,
          "",
          std::move(help),
          [field](Config& config, const std::string& value) { config.*field = to_flag(value); },
          [field](const Config& config) { return config.*field ? "true" : "false"; }};
}

void set_listen(Config& config, const std::string& value) {
  parse_listen_address(value);
  config.listen = value;
}

void set_metrics_listen(Config& config, const std::string& value) {
  if (!value.empty() && !parse_listen_address(value).socket_path.empty()) {
    throw std::invalid_argument(std::string("\"") + value + "\" is not HOST:PORT");
  }
  config.metrics_listen = value;
}

void append(std::vector<Key>& all, std::vector<Key> more) {
  std::move(more.begin(), more.end(), std::back_inserter(all));
}

std::vector<Key> access_keys() {
  return {
      {"listen", KeyType::text, "ADDRESS", "HOST:PORT (port 0 picks a free one) or unix:PATH",
       set_listen, [](const Config& config) { return config.listen; }},
      flag("allow-insecure-remote", "Listen beyond this machine although nothing is encrypted",
           &Config::allow_insecure_remote),
      text("tls-certificate", "FILE",
           "Certificate of the server and those between it and the root, PEM; default: no TLS",
           &Config::tls_certificate),
      text("tls-key", "FILE", "Its private key, PEM, readable for nobody else", &Config::tls_key),
      text("tls-client-roots", "FILE",
           "Roots, PEM: clients need a certificate that goes back to one of them",
           &Config::tls_client_roots),
      text("tokens", "FILE", "Lines NAME ROLE SHA256: clients need such a token", &Config::tokens),
      text("admins", "NAMES",
           "Common names, with commas between, whose certificates are administrators'",
           &Config::admins),
  };
}

std::vector<Key> store_keys() {
  constexpr std::int64_t million = 1'000'000;
  return {
      text("data-dir", "DIR",
           "What is kept; default $XDG_STATE_HOME/anticrack or ~/.local/state/anticrack",
           &Config::data_dir),
      bytes("disk-budget", "For all of the data folder; 0: as much as the disk has",
            &Config::disk_budget, 0),
      count("kept-jobs", "Ended jobs kept; the oldest are forgotten first", &Config::kept_jobs, 1,
            million),
      time("result-ttl", "Then the result of an ended job expires; 0: never", &Config::result_ttl),
      bytes("result-budget", "Results of ended jobs together; the oldest expire first",
            &Config::result_budget, 1 << 20),
      time("upload-ttl", "Then an upload nothing refers to is removed", &Config::upload_ttl,
           seconds(60)),
  };
}

std::vector<Key> mesh_keys() {
  constexpr std::int64_t million = 1'000'000;
  return {
      text("mesher", "PATH", "The helper anticrack-mesher; default: beside anticrackd",
           &Config::mesher),
      time("meshing-time", "Limit for one mesh, then the mesher is killed", &Config::meshing_time),
      bytes("mesher-memory", "Address space of the mesher", &Config::mesher_memory, 256 << 20),
      count("mesh-triangles", "Triangles of one mesh", &Config::mesh_triangles, 1, 1000 * million),
      count("pending-meshes", "Meshes that may wait for the mesher", &Config::pending_meshes, 1,
            million),
      count("kept-meshes", "Meshes kept; beyond it one has to be deleted first",
            &Config::kept_meshes, 1, million),
      bytes("upload-limit", "Size of an uploaded .msh or array", &Config::upload_limit, 1),
      bytes("memory-budget",
            "For all factorised meshes together, e.g. 2GiB; default: half of memory",
            &Config::memory_budget, 1 << 20),
  };
}

std::vector<Key> job_keys() {
  constexpr std::int64_t million = 1'000'000;
  return {
      count("threads", "Threads that solve; default: processors", &Config::threads, 1, 1024),
      count("columns", "Load cases of one mesh that iterate together", &Config::columns, 1, 4'096),
      // All of a job's answers, and the layout of its results, must fit in a message of 4 MiB.
      count("load-cases", "Load cases of one job", &Config::load_cases, 1, 4'000),
      count("max-sweep-rows", "Rows of one sweep", &Config::max_sweep_rows, 1, 1000 * million),
      count("max-sweep-basis", "Load cases that one sweep combines", &Config::max_sweep_basis, 1,
            4'000),
      count("iterations", "Iterations of one load case", &Config::iterations, 1, 1000 * million),
      count("expression-bytes", "Length of an expression", &Config::expression_bytes, 1, 65'536),
      bytes("result-limit", "Answers of one job, with their history", &Config::result_limit,
            1 << 20),
      bytes("event-log", "Events kept of one job; the oldest go first", &Config::event_log,
            64 << 10),
      count("queued-jobs", "Jobs that may wait or run", &Config::queued_jobs, 1, million),
      count("queued-cases", "Load cases of one mesh that may wait or run", &Config::queued_cases, 1,
            1000 * million),
      bytes("queued-bytes", "Definitions of all jobs that have not ended", &Config::queued_bytes,
            1 << 20),
      count("crashes", "A job fails when the server has crashed so often while it ran; 0: never",
            &Config::crashes, 0, million),
      time("queue-time", "Longest a job may wait; then it fails", &Config::queue_time, seconds(1)),
      time("run-time", "Longest a job may run; then it fails", &Config::run_time, seconds(1)),
  };
}

std::vector<Key> service_keys() {
  return {
      count("watchers", "Watches open at once", &Config::watchers, 1, 100'000),
      count("transfers", "Uploads and downloads under way at once", &Config::transfers, 1, 10'000),
      count("streams-a-client", "Of these, how many one client may hold", &Config::streams_a_client,
            1, 100'000),
      time("drain-delay", "After SIGTERM: serve on, not ready any more, so that balancers notice",
           &Config::drain_delay),
      time("drain-time", "Then: how long running jobs may go on", &Config::drain_time),
      word("log-level", "trace, debug, info, warn, error or off",
           {"trace", "debug", "info", "warn", "error", "off"}, &Config::log_level),
      word("log-format", "text or json", {"text", "json"}, &Config::log_format),
      {"metrics-listen", KeyType::text, "ADDRESS",
       "HOST:PORT where Prometheus reads /metrics; default: nowhere", set_metrics_listen,
       [](const Config& config) { return config.metrics_listen; }},
  };
}

std::vector<Key> make_keys() {
  std::vector<Key> all = access_keys();
  append(all, store_keys());
  append(all, mesh_keys());
  append(all, job_keys());
  append(all, service_keys());
  return all;
}

}  // namespace

const std::vector<Key>& keys() {
  static const std::vector<Key> all = make_keys();
  return all;
}

const Key& find_key(const std::string& name, const std::string& where) {
  std::vector<std::string> names;
  for (const Key& key : keys()) {
    if (key.name == name) return key;
    names.push_back(key.name);
  }
  throw ConfigError(where + ": unknown key \"" + name + "\"; did you mean \"" +
                    nearest(name, names) + "\"?");
}

}  // namespace anticrack::app
