// SPDX-License-Identifier: GPL-3.0-or-later
//
// The table of keys.
#include <algorithm>
#include <utility>

#include "app/config.hpp"
#include "app/listen_address.hpp"
#include "app/nearest.hpp"
#include "app/values.hpp"

namespace anticrack::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::int64_t million = 1'000'000;

/// A key for a member of Config: `read` makes the value from text and checks it, `show` is its
/// inverse.
template <class T, class Read, class Show>
Key key(const char* name, KeyType type, const char* placeholder, const char* help, T Config::*field,
        Read read, Show show) {
  return {name,
          type,
          placeholder,
          help,
          [field, read](Config& config, const std::string& value) { config.*field = read(value); },
          [field, show](const Config& config) { return show(config.*field); }};
}

std::string same(const std::string& text) {
  return text;
}

/// An empty text means that the key is not given; the help says what follows.
Key text(const char* name, const char* placeholder, const char* help, std::string Config::*field) {
  return key(name, KeyType::text, placeholder, help, field, same, same);
}

Key word(const char* name, const char* help, const std::vector<std::string>& known,
         std::string Config::*field) {
  const auto read = [known](const std::string& value) {
    if (std::find(known.begin(), known.end(), value) != known.end()) return value;
    throw std::invalid_argument("unknown word \"" + value + "\"; did you mean \"" +
                                nearest(value, known) + "\"?");
  };
  return key(name, KeyType::text, "WORD", help, field, read, same);
}

Key address(const char* name, const char* help, bool may_be_socket, std::string Config::*field) {
  const auto read = [may_be_socket](const std::string& value) {
    if (!may_be_socket && value.empty()) return value;
    if (!parse_listen_address(value).socket_path.empty() && !may_be_socket) {
      throw std::invalid_argument("\"" + value + "\" is not HOST:PORT");
    }
    return value;
  };
  return key(name, KeyType::text, "ADDRESS", help, field, read, same);
}

Key bytes(const char* name, const char* help, std::uint64_t Config::*field, std::uint64_t least) {
  const auto read = [least](const std::string& value) { return to_bytes(value, least); };
  return key(name, KeyType::number, "BYTES", help, field, read, from_bytes);
}

template <class Integer>
Key count(const char* name, const char* help, Integer Config::*field, std::int64_t least,
          std::int64_t most) {
  const auto read = [least, most](const std::string& value) {
    return static_cast<Integer>(to_integer(value, least, most));
  };
  return key(name, KeyType::number, "N", help, field, read,
             [](Integer value) { return std::to_string(value); });
}

Key time(const char* name, const char* help, milliseconds Config::*field,
         milliseconds least = milliseconds(0)) {
  const auto read = [least](const std::string& value) { return to_time(value, least); };
  return key(name, KeyType::number, "TIME", help, field, read, from_time);
}

Key flag(const char* name, const char* help, bool Config::*field) {
  return key(name, KeyType::flag, "", help, field, to_flag,
             [](bool value) { return value ? "true" : "false"; });
}

}  // namespace

const std::vector<Key>& keys() {
  static const std::vector<Key> all{
      address("listen", "HOST:PORT (port 0: any free port) or unix:PATH", true, &Config::listen),
      flag("allow-insecure-remote", "Listen beyond this machine without encryption",
           &Config::allow_insecure_remote),
      text("tls-certificate", "FILE",
           "Certificate chain of the server without the root, PEM; default: no TLS",
           &Config::tls_certificate),
      text("tls-key", "FILE",
           "Private key of the certificate, PEM, readable only by its owner and group",
           &Config::tls_key),
      text("tls-client-roots", "FILE",
           "Root certificates, PEM: clients need a certificate issued by one of them",
           &Config::tls_client_roots),
      text("tokens", "FILE", "Lines NAME ROLE SHA256: clients need one of these tokens",
           &Config::tokens),
      text("admins", "NAMES",
           "Common names, separated by commas, whose certificates are administrators'",
           &Config::admins),

      text("data-dir", "DIR",
           "Folder of all data; default $XDG_STATE_HOME/anticrack or ~/.local/state/anticrack",
           &Config::data_dir),
      bytes("disk-budget", "Limit of the data folder; 0: the size of the disk",
            &Config::disk_budget, 0),
      count("kept-jobs", "Ended jobs kept; the oldest are removed first", &Config::kept_jobs, 1,
            million),
      time("result-ttl", "Time after which the result of an ended job expires; 0: never",
           &Config::result_ttl),
      bytes("result-budget", "Results of all ended jobs; the oldest expire first",
            &Config::result_budget, 1 << 20),
      time("upload-ttl", "Time after which an unused upload is removed", &Config::upload_ttl,
           seconds(60)),

      text("mesher", "PATH", "The helper anticrack-mesher; default: beside anticrackd",
           &Config::mesher),
      time("meshing-time", "Time limit for one mesh; then the mesher is killed",
           &Config::meshing_time),
      bytes("mesher-memory", "Address space of the mesher", &Config::mesher_memory, 256 << 20),
      count("mesh-triangles", "Triangles of one mesh", &Config::mesh_triangles, 1, 1000 * million),
      count("pending-meshes", "Meshes that may wait for the mesher", &Config::pending_meshes, 1,
            million),
      count("kept-meshes", "Meshes kept; to create more, delete some", &Config::kept_meshes, 1,
            million),
      bytes("upload-limit", "Size of an uploaded .msh or array", &Config::upload_limit, 1),
      bytes("memory-budget", "Memory for all factorised meshes, e.g. 2GiB; default: half of memory",
            &Config::memory_budget, 1 << 20),

      count("threads", "Solver threads; default: number of processors", &Config::threads, 1, 1024),
      count("columns", "Load cases of one mesh solved together", &Config::columns, 1, 4'096),
      // All of a job's answers, and the layout of its results, must fit in a message of 4 MiB.
      count("load-cases", "Load cases of one job", &Config::load_cases, 1, 4'000),
      count("max-sweep-rows", "Rows of one sweep", &Config::max_sweep_rows, 1, 1000 * million),
      count("max-sweep-basis", "Load cases that one sweep combines", &Config::max_sweep_basis, 1,
            4'000),
      count("iterations", "Iterations of one load case", &Config::iterations, 1, 1000 * million),
      count("expression-bytes", "Length of an expression", &Config::expression_bytes, 1, 65'536),
      bytes("result-limit", "Results of one job, histories included", &Config::result_limit,
            1 << 20),
      bytes("event-log", "Events kept per job; the oldest are dropped first", &Config::event_log,
            64 << 10),
      count("queued-jobs", "Jobs that may wait or run", &Config::queued_jobs, 1, million),
      count("queued-cases", "Load cases of one mesh that may wait or run", &Config::queued_cases, 1,
            1000 * million),
      bytes("queued-bytes", "Definitions of all jobs that have not ended", &Config::queued_bytes,
            1 << 20),
      count("crashes", "Crashes of the server during a job, after which the job fails; 0: no limit",
            &Config::crashes, 0, million),
      time("queue-time", "Longest wait of a job; then it fails", &Config::queue_time, seconds(1)),
      time("run-time", "Longest run of a job; then it fails", &Config::run_time, seconds(1)),

      count("watchers", "Watches open at once", &Config::watchers, 1, 100'000),
      count("transfers", "Uploads and downloads at once", &Config::transfers, 1, 10'000),
      count("streams-a-client", "Watches and transfers that one client may have open",
            &Config::streams_a_client, 1, 100'000),
      time("drain-delay",
           "After SIGTERM: how long to go on serving as not ready, for load balancers",
           &Config::drain_delay),
      time("drain-time", "After that: how long running jobs may go on", &Config::drain_time),
      word("log-level", "trace, debug, info, warn, error or off",
           {"trace", "debug", "info", "warn", "error", "off"}, &Config::log_level),
      word("log-format", "text or json", {"text", "json"}, &Config::log_format),
      address("metrics-listen", "HOST:PORT where Prometheus reads /metrics; default: no metrics",
              false, &Config::metrics_listen),
  };
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
