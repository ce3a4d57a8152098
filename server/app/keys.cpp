// SPDX-License-Identifier: GPL-3.0-or-later
//
// The table of keys.
#include <algorithm>
#include <type_traits>
#include <utility>

#include "app/config.hpp"
#include "app/listen_address.hpp"
#include "app/values.hpp"
#include "words/nearest.hpp"

namespace anticrack::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::int64_t million = 1'000'000;

using Helper = mesher::HelperOptions;
using Jobs = jobs::EngineOptions;
using Limits = rpc::Limits;
using Meshes = meshes::CatalogueOptions;
using Store = store::StoreOptions;

/// The options of this type in a configuration.
template <class Part>
auto& part(auto& config) {
  if constexpr (std::is_same_v<Part, Jobs>)
    return config.jobs;
  else if constexpr (std::is_same_v<Part, Limits>)
    return config.limits;
  else if constexpr (std::is_same_v<Part, Meshes>)
    return config.meshes;
  else if constexpr (std::is_same_v<Part, Helper>)
    return config.meshes.helper;
  else if constexpr (std::is_same_v<Part, Store>)
    return config.store;
  else
    return config;
}

/// A key for a member of the configuration: `read` makes the value from text and checks it, `show`
/// is its inverse.
template <class T, class Part, class Read, class Show>
Key key(const char* name, KeyType type, const char* placeholder, const char* help, T Part::*field,
        Read read, Show show) {
  return {name,
          type,
          placeholder,
          help,
          [field, read](Config& config, const std::string& value) {
            part<Part>(config).*field = read(value);
          },
          [field, show](const Config& config) { return show(part<Part>(config).*field); }};
}

std::string same(const std::string& text) { return text; }

/// A key for text; an empty text means that the key is not given, and the help says what follows.
template <class Part>
Key text(const char* name, const char* placeholder, const char* help, std::string Part::*field) {
  return key(name, KeyType::text, placeholder, help, field, same, same);
}

Key word(const char* name, const char* help, const std::vector<std::string>& known,
         std::string Config::*field) {
  const auto read = [known](const std::string& value) {
    if (std::find(known.begin(), known.end(), value) != known.end()) return value;
    throw std::invalid_argument("unknown word \"" + value + "\"; " +
                                words::suggestion(value, known));
  };
  return key(name, KeyType::text, "WORD", help, field, read, same);
}

template <class Part>
Key address(const char* name, const char* help, bool may_be_socket, std::string Part::*field) {
  const auto read = [may_be_socket](const std::string& value) {
    if (!may_be_socket && value.empty()) return value;
    if (!parse_listen_address(value).socket_path.empty() && !may_be_socket)
      throw std::invalid_argument("\"" + value + "\" is not HOST:PORT");
    return value;
  };
  return key(name, KeyType::text, "ADDRESS", help, field, read, same);
}

template <class Part>
Key bytes(const char* name, const char* help, std::uint64_t Part::*field, std::uint64_t least) {
  const auto read = [least](const std::string& value) { return to_bytes(value, least); };
  return key(name, KeyType::number, "BYTES", help, field, read, from_bytes);
}

template <class Integer, class Part>
Key count(const char* name, const char* help, Integer Part::*field, std::int64_t least,
          std::int64_t most) {
  const auto read = [least, most](const std::string& value) {
    return static_cast<Integer>(to_integer(value, least, most));
  };
  return key(name, KeyType::number, "N", help, field, read,
             [](Integer value) { return std::to_string(value); });
}

template <class Part>
Key time(const char* name, const char* help, milliseconds Part::*field,
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
           "Common names of certificates, separated by commas, whose holders are administrators",
           &Config::admins),

      text("data-dir", "DIR",
           "Folder of all data; default $XDG_STATE_HOME/anticrack or ~/.local/state/anticrack",
           &Store::folder),
      text("store", "URL",
           "postgresql://USER@HOST/DATABASE, which other servers may share (the password is in "
           "PGPASSFILE); default: SQLite in the data folder",
           &Store::url),
      bytes("disk-budget", "Limit of the data folder; 0: the size of the disk", &Store::disk_budget,
            0),
      count("kept-jobs",
            "Ended jobs to keep; beyond that the oldest of the user who has most are removed",
            &Jobs::max_kept_jobs, 1, million),
      time("result-ttl", "Time after which the result of an ended job expires; 0: never",
           &Jobs::result_ttl),
      bytes("result-budget",
            "Results of all ended jobs; beyond that the oldest of the user who has most expire",
            &Jobs::result_budget, 1 << 20),
      time("upload-ttl", "Time after which an unused upload is removed", &Jobs::upload_ttl,
           seconds(60)),

      text("mesher", "PATH", "The helper anticrack-mesher; default: beside anticrackd",
           &Helper::executable),
      time("meshing-time", "Time limit for one mesh; then the mesher is killed",
           &Config::meshing_time),
      bytes("mesher-memory", "Address space of the mesher", &Helper::memory_limit, 256 << 20),
      count("mesh-triangles", "Triangles of one mesh", &Meshes::max_triangles, 1, 1000 * million),
      count("pending-meshes", "Meshes that may wait for the mesher", &Meshes::max_pending, 1,
            million),
      count("kept-meshes", "Meshes kept; to create more, delete some", &Meshes::max_meshes, 1,
            million),
      bytes("upload-limit", "Size of an uploaded .msh or array", &Limits::upload_bytes, 1),
      bytes(
          "memory-budget",
          "Memory for all factorised meshes, e.g. 2GiB; default: half of what the machine, control "
          "groups and ulimit -v allow",
          &Limits::memory_budget_bytes, least_memory_budget),

      count("threads",
            "Solver threads; default: the processors that affinity and control groups allow",
            &Jobs::threads, 1, 1024),
      count("columns", "Load cases of one mesh solved together", &Jobs::columns, 1, 4'096),
      // All of a job's answers, and the layout of its results, must fit in a message of 4 MiB.
      count("load-cases", "Load cases of one job", &Jobs::max_load_cases, 1, 4'000),
      count("max-sweep-rows", "Rows of one sweep", &Jobs::max_sweep_rows, 1, 1000 * million),
      count("max-sweep-basis", "Load cases that one sweep combines", &Jobs::max_sweep_basis, 1,
            4'000),
      count("iterations", "Iterations of one load case", &Jobs::max_iterations, 1, 1000 * million),
      count("expression-bytes", "Length of an expression", &Jobs::max_expression_bytes, 1, 65'536),
      bytes("result-limit", "Results of one job, histories included", &Jobs::max_result_bytes,
            1 << 20),
      bytes("event-log", "Events kept per job; the oldest are dropped first",
            &Jobs::event_log_bytes, 64 << 10),
      count("queued-jobs", "Jobs that may wait or run", &Jobs::max_queued_jobs, 1, million),
      count("queued-cases", "Load cases of one mesh that may wait or run", &Jobs::max_queued_cases,
            1, 1000 * million),
      bytes("job-memory", "Definitions, events and answers of all jobs in memory",
            &Jobs::max_job_memory, 16 << 20),
      count("crashes", "Crashes of the server during a job, after which the job fails; 0: no limit",
            &Jobs::max_crashes, 0, million),
      time("queue-time", "Longest wait of a job; then it fails", &Jobs::queue_time, seconds(1)),
      time("run-time", "Longest run of a job; then it fails", &Jobs::run_time, seconds(1)),

      count("connections",
            "Connections open at once; default: 4096, or what the limit of open files leaves",
            &Limits::connections, 0, million),
      count("connections-an-address", "Connections that one address may have",
            &Limits::connections_an_address, 1, million),
      count("watchers", "Watches open at once", &Limits::watchers, 1, 100'000),
      count("transfers", "Uploads and downloads at once", &Limits::transfers, 1, 10'000),
      count("streams-a-client", "Watches and transfers that one client may have open",
            &Limits::streams_a_client, 1, 100'000),
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
  throw ConfigError(where + ": unknown key \"" + name + "\"; " + words::suggestion(name, names));
}

}  // namespace anticrack::app
