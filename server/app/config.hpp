// SPDX-License-Identifier: GPL-3.0-or-later
//
// The configuration: one table of keys, each of which is a flag of the command line and a key of
// the TOML file.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "jobs/job_engine.hpp"
#include "meshes/mesh_catalogue.hpp"
#include "rpc/backend.hpp"
#include "store/store.hpp"

namespace anticrack::app {

struct Config {
  std::string listen = "127.0.0.1:7433";
  bool allow_insecure_remote = false;
  std::string log_level = "info";
  std::string log_format = "text";
  std::string metrics_listen;                ///< empty: no metrics
  std::chrono::milliseconds drain_delay{0};  ///< time to go on serving while not ready
  std::chrono::milliseconds drain_time{3'000};
  std::chrono::milliseconds meshing_time{600'000};

  // Paths; empty: none.
  std::string tls_certificate;
  std::string tls_key;
  std::string tls_client_roots;
  std::string tokens;
  std::string admins;  ///< comma separated

  // Options of the layers; options.hpp completes them.
  store::StoreOptions store;        ///< empty folder: default_data_dir()
  meshes::CatalogueOptions meshes;  ///< empty helper executable: the one beside this program
  /// A memory budget of 0 means half of Machine::memory_bytes; 0 connections means that
  /// fit_connections() sets them.
  rpc::Limits limits{.connections = 0};
  /// 0 threads means Machine::processors.
  jobs::EngineOptions jobs{.threads = 0, .max_load_cases = 1'000, .event_log_bytes = 8u << 20};
};

constexpr std::uint64_t least_memory_budget = 1 << 20;

/// A fault of the configuration. The message is one line: where it is (file and line, or flag), the
/// bad value and the cure.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class KeyType { text, number, flag };

struct Key {
  std::string name;  ///< "memory-budget": the flag is --memory-budget
  KeyType type;
  std::string placeholder;  ///< stands for the value in the help
  std::string help;
  /// Sets the value from text. Throws std::invalid_argument with one sentence.
  std::function<void(Config&, const std::string&)> set;
  /// The value as a text that `set` reads.
  std::function<std::string(const Config&)> get;
};

/// All keys, in the order of the help. Names are unique.
const std::vector<Key>& keys();

/// Throws ConfigError for an unknown name; it suggests the most similar key.
const Key& find_key(const std::string& name, const std::string& where);

/// A value that was given, and the place.
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

}  // namespace anticrack::app
