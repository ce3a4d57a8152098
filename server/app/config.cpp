// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/config.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <thread>

#include "app/listen_address.hpp"

namespace anticrack::app {
namespace {

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
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code == 0x7F) {
      result += fmt::format("\\u{:04X}", code);
      continue;
    }
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
}

bool is_plain_number(const std::string& text) {
  return text.find_first_not_of("0123456789.") == std::string::npos;
}

/// Keys that need other keys.
void check_together(const Config& config) {
  if (config.tls_certificate.empty() != config.tls_key.empty()) {
    throw ConfigError(
        "tls-certificate and tls-key belong together: give both (deploy/make-certificates makes "
        "test certificates) or neither");
  }
  if (!config.tls_client_roots.empty() && !has_tls(config))
    throw ConfigError("tls-client-roots needs TLS: give tls-certificate and tls-key as well");
  if (!config.admins.empty() && config.tls_client_roots.empty()) {
    throw ConfigError(
        "admins names client certificates, but clients need none: give tls-client-roots, or make "
        "them administrators in the token file");
  }
  require_local(parse_listen_address(config.listen),
                has_tls(config) || config.allow_insecure_remote);
}

}  // namespace

bool has_tls(const Config& config) { return !config.tls_certificate.empty(); }

Config make_config(const std::vector<Setting>& file, const std::vector<Setting>& command_line) {
  Config config;
  apply(file, config);
  apply(command_line, config);
  if (config.store.folder.empty()) config.store.folder = default_data_dir();
  if (config.limits.memory_budget_bytes == 0)
    config.limits.memory_budget_bytes = default_memory_budget();
  if (config.jobs.threads == 0)
    config.jobs.threads = std::max(1u, std::thread::hardware_concurrency());
  check_together(config);
  return config;
}

std::string to_toml(const Config& config) {
  std::string toml;
  for (const Key& key : keys()) {
    const std::string value = key.get(config);
    const bool bare =
        key.type == KeyType::flag || (key.type == KeyType::number && is_plain_number(value));
    toml += key.name + " = " + (bare ? value : quoted(value)) + "\n";
  }
  return toml;
}

std::string default_data_dir() {
  if (const char* state = std::getenv("XDG_STATE_HOME"); state != nullptr && *state == '/')
    return std::string(state) + "/anticrack";
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/')
    return std::string(home) + "/.local/state/anticrack";
  throw ConfigError("neither XDG_STATE_HOME nor HOME is set: choose a folder with --data-dir DIR");
}

std::uint64_t default_memory_budget() {
  const long pages = ::sysconf(_SC_PHYS_PAGES);
  const long page = ::sysconf(_SC_PAGESIZE);
  if (pages <= 0 || page <= 0) return 1ULL << 30;
  return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page) / 2;
}

}  // namespace anticrack::app
