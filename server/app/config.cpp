// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/config.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>

#include "app/address_space.hpp"
#include "app/listen_address.hpp"
#include "app/machine.hpp"
#include "app/values.hpp"

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

/// Checks keys that need other keys.
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

/// Sets the defaults that depend on the machine. Throws ConfigError if ulimit -v (0: none) leaves
/// too little room.
void fit_machine(const Machine& machine, std::uint64_t address_space, Config& config) {
  if (config.jobs.threads == 0) config.jobs.threads = machine.processors;
  const auto count = [](int number) { return static_cast<std::uint64_t>(number); };
  const std::uint64_t other =
      address_space_to_serve(count(machine.processors), count(config.jobs.threads));
  const std::uint64_t room = address_space - std::min(address_space, other);
  std::uint64_t& budget = config.limits.memory_budget_bytes;
  constexpr std::uint64_t least_useful = 64 << 20;
  const std::uint64_t wanted = budget == 0 ? least_useful : budget;
  if (address_space > 0 && room < wanted + least_useful) {
    constexpr std::uint64_t kibibyte = 1024;
    throw ConfigError(fmt::format(
        "ulimit -v (address space) of {} KiB is too small: with {} threads and a memory-budget of "
        "{} the server takes {} KiB; raise it, or start with fewer threads or a smaller "
        "memory-budget",
        address_space / kibibyte, config.jobs.threads, from_bytes(wanted),
        (other + wanted + least_useful) / kibibyte));
  }
  if (budget > 0) return;
  const std::uint64_t memory =
      address_space > 0 ? std::min(machine.memory_bytes, room) : machine.memory_bytes;
  budget = std::max(least_memory_budget, memory / 2);
}

}  // namespace

bool has_tls(const Config& config) { return !config.tls_certificate.empty(); }

Config make_config(const std::vector<Setting>& file, const std::vector<Setting>& command_line) {
  Config config;
  apply(file, config);
  apply(command_line, config);
  if (config.store.folder.empty()) config.store.folder = default_data_dir();
  fit_machine(this_machine(), address_space_limit(), config);
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

}  // namespace anticrack::app
