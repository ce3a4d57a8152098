// SPDX-License-Identifier: GPL-3.0-or-later
//
// The configuration: one table of keys. Each is a flag of the command line and a key of the TOML
// file.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace anticrack::app {

struct Config {
  std::string listen = "127.0.0.1:7433";
  bool allow_insecure_remote = false;
  std::string data_dir;             ///< empty: default_data_dir()
  std::uint64_t memory_budget = 0;  ///< 0: default_memory_budget()
  int threads = 0;                  ///< 0: the number of processors
  std::string log_level = "info";
  std::string log_format = "text";
  std::string metrics_listen;                ///< empty: no metrics
  std::chrono::milliseconds drain_delay{0};  ///< still serving, but not ready
  std::chrono::milliseconds drain_time{3'000};

  // Paths; empty: none.
  std::string tls_certificate;
  std::string tls_key;
  std::string tls_client_roots;
  std::string tokens;
  std::string admins;  ///< comma separated

  std::string mesher;  ///< empty: beside the executable
  std::chrono::milliseconds meshing_time{600'000};
  std::uint64_t mesher_memory = 6ULL << 30;
  std::uint64_t mesh_triangles = 4'000'000;
  int pending_meshes = 64;
  int kept_meshes = 10'000;
  std::uint64_t upload_limit = 256ULL << 20;

  int load_cases = 1'000;
  std::uint64_t max_sweep_rows = 10'000'000;
  int max_sweep_basis = 256;
  int iterations = 1'000'000;
  int expression_bytes = 4'096;
  int columns = 32;
  int queued_jobs = 1'000;
  int crashes = 3;
  int queued_cases = 100'000;
  std::uint64_t queued_bytes = 256ULL << 20;
  std::chrono::milliseconds queue_time{std::chrono::hours(24)};
  std::chrono::milliseconds run_time{std::chrono::hours(24)};
  std::uint64_t result_limit = 2ULL << 30;
  std::uint64_t event_log = 8ULL << 20;

  int kept_jobs = 10'000;
  std::chrono::milliseconds result_ttl{std::chrono::hours(7 * 24)};
  std::uint64_t result_budget = 4ULL << 30;
  std::chrono::milliseconds upload_ttl{std::chrono::hours(7 * 24)};
  std::uint64_t disk_budget = 0;  ///< 0: the size of the disk

  int watchers = 2'000;
  int transfers = 64;
  int streams_a_client = 1'024;
};

/// One line: where (file and line, or flag), the bad value and the cure.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class KeyType { text, number, flag };

struct Key {
  std::string name;  ///< "memory-budget": the flag is --memory-budget
  KeyType type;
  std::string placeholder;  ///< of the value in the help
  std::string help;
  /// Throws std::invalid_argument with one sentence.
  std::function<void(Config&, const std::string&)> set;
  /// The value, as `set` would read it.
  std::function<std::string(const Config&)> get;
};

/// All keys, in the order of the help. Names are unique.
const std::vector<Key>& keys();

/// Throws ConfigError for an unknown name; it suggests the most similar key.
const Key& find_key(const std::string& name, const std::string& where);

/// A value that was given, and where.
struct Setting {
  std::string key;
  std::string value;
  std::string where;  ///< "FILE:LINE" or "--FLAG"
};

/// Defaults, overridden by `file`, overridden by `command_line`; values that depend on the machine
/// are filled in. Throws ConfigError for bad values, contradictions, and a server that is open to
/// other machines without --allow-insecure-remote.
Config make_config(const std::vector<Setting>& file, const std::vector<Setting>& command_line);

/// Whether connections are encrypted.
bool has_tls(const Config& config);

/// A TOML file with the same configuration.
std::string to_toml(const Config& config);

/// $XDG_STATE_HOME/anticrack or ~/.local/state/anticrack. Throws ConfigError if neither is set.
std::string default_data_dir();

/// Half of the machine's memory, bytes.
std::uint64_t default_memory_budget();

}  // namespace anticrack::app
