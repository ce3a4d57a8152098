// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/config.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <thread>
#include <utility>

#include "app/listen_address.hpp"
#include "app/nearest.hpp"
#include "app/values.hpp"

namespace anticrack::app {
namespace {

constexpr std::array log_levels{"trace", "debug", "info", "warn", "error", "off"};

Key text(std::string name, std::string placeholder, std::string help, std::string Config::*field) {
  return {std::move(name),
          KeyType::text,
          std::move(placeholder),
          std::move(help),
          [field](Config& config, const std::string& value) {
            if (value.empty()) throw std::invalid_argument("the value is empty");
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
              throw std::invalid_argument("\"" + value + "\" is too small; give at least " +
                                          from_bytes(least));
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

Key time(std::string name, std::string help, std::chrono::milliseconds Config::*field) {
  return {std::move(name),
          KeyType::number,
          "SECONDS",
          std::move(help),
          [field](Config& config, const std::string& value) { config.*field = to_time(value); },
          [field](const Config& config) { return from_time(config.*field); }};
}

void set_log_level(Config& config, const std::string& value) {
  const std::vector<std::string> known(log_levels.begin(), log_levels.end());
  if (std::find(known.begin(), known.end(), value) == known.end()) {
    throw std::invalid_argument("\"" + value + "\" is no log level; did you mean \"" +
                                nearest(value, known) + "\"?");
  }
  config.log_level = value;
}

void set_listen(Config& config, const std::string& value) {
  parse_listen_address(value);
  config.listen = value;
}

std::vector<Key> make_keys() {
  constexpr std::int64_t million = 1'000'000;
  return {
      {"listen", KeyType::text, "ADDRESS", "HOST:PORT (port 0 picks a free one) or unix:PATH",
       set_listen, [](const Config& config) { return config.listen; }},
      {"allow-insecure-remote", KeyType::flag, "",
       "Listen beyond this machine although nothing is encrypted and nobody is asked who they are",
       [](Config& config, const std::string& value) {
         config.allow_insecure_remote = to_flag(value);
       },
       [](const Config& config) { return config.allow_insecure_remote ? "true" : "false"; }},
      text("data-dir", "DIR",
           "Where uploads are kept; default $XDG_STATE_HOME/anticrack or ~/.local/state/anticrack",
           &Config::data_dir),
      bytes("memory-budget",
            "For all factorised meshes together, e.g. 2GiB; default: half of memory",
            &Config::memory_budget, 1 << 20),
      count("threads", "Load cases solved at once; default: processors", &Config::threads, 1, 1024),
      {"log-level", KeyType::text, "LEVEL", "trace, debug, info, warn, error or off", set_log_level,
       [](const Config& config) { return config.log_level; }},
      time("drain-time", "How long running jobs may go on after SIGTERM", &Config::drain_time),
      text("mesher", "PATH", "The helper anticrack-mesher; default: beside anticrackd",
           &Config::mesher),
      time("meshing-time", "Limit for one mesh, then the mesher is killed", &Config::meshing_time),
      bytes("mesher-memory", "Address space of the mesher", &Config::mesher_memory, 256 << 20),
      count("mesh-triangles", "Triangles of one mesh", &Config::mesh_triangles, 1, 1000 * million),
      count("pending-meshes", "Meshes that may wait for the mesher", &Config::pending_meshes, 1,
            million),
      bytes("upload-limit", "Size of an uploaded .msh", &Config::upload_limit, 1),
      // All of a job's answers, and the layout of its results, must fit in a message of 4 MiB.
      count("load-cases", "Load cases of one job", &Config::load_cases, 1, 4'000),
      count("iterations", "Iterations of one load case", &Config::iterations, 1, 1000 * million),
      count("expression-bytes", "Length of an expression", &Config::expression_bytes, 1, 65'536),
      count("queued-jobs", "Jobs that may wait", &Config::queued_jobs, 1, million),
      count("kept-jobs", "Ended jobs kept with their results; the oldest go first",
            &Config::kept_jobs, 1, million),
      bytes("kept-bytes", "Results and events of ended jobs together; the oldest jobs go first",
            &Config::kept_bytes, 1 << 20),
      bytes("event-log", "Events kept of one job; the oldest go first", &Config::event_log,
            64 << 10),
      count("watchers", "Watches open at once", &Config::watchers, 1, 100'000),
      count("transfers", "Uploads and downloads under way at once", &Config::transfers, 1, 10'000),
  };
}

void apply(const std::vector<Setting>& settings, Config& config) {
  for (const Setting& setting : settings) {
    try {
      find_key(setting.key, setting.where).set(config, setting.value);
    } catch (const std::invalid_argument& problem) {
      const bool flag = setting.where == "--" + setting.key;
      throw ConfigError(setting.where + ": " + (flag ? "" : setting.key + ": ") + problem.what());
    }
  }
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
}

bool is_plain_number(const std::string& text) {
  return text.find_first_not_of("0123456789.") == std::string::npos;
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

Config make_config(const std::vector<Setting>& file, const std::vector<Setting>& command_line) {
  Config config;
  apply(file, config);
  apply(command_line, config);
  if (config.data_dir.empty()) config.data_dir = default_data_dir();
  if (config.memory_budget == 0) config.memory_budget = default_memory_budget();
  if (config.threads == 0) config.threads = std::max(1u, std::thread::hardware_concurrency());
  require_local(parse_listen_address(config.listen), config.allow_insecure_remote);
  return config;
}

std::string to_toml(const Config& config) {
  std::string toml;
  for (const Key& key : keys()) {
    const std::string value = key.get(config);
    if (value.empty()) continue;
    const bool bare =
        key.type == KeyType::flag || (key.type == KeyType::number && is_plain_number(value));
    toml += key.name + " = " + (bare ? value : quoted(value)) + "\n";
  }
  return toml;
}

std::string default_data_dir() {
  if (const char* state = std::getenv("XDG_STATE_HOME"); state != nullptr && *state == '/') {
    return std::string(state) + "/anticrack";
  }
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/') {
    return std::string(home) + "/.local/state/anticrack";
  }
  throw ConfigError(
      "neither XDG_STATE_HOME nor HOME is set: say where to keep data, --data-dir DIR");
}

std::uint64_t default_memory_budget() {
  const long pages = ::sysconf(_SC_PHYS_PAGES);
  const long page = ::sysconf(_SC_PAGESIZE);
  if (pages <= 0 || page <= 0) return 1ULL << 30;
  return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page) / 2;
}

}  // namespace anticrack::app
