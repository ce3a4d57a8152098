// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/security.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <functional>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

#include "access/tokens.hpp"
#include "app/listen_address.hpp"
#include "app/options.hpp"
#include "app/secret_file.hpp"
#include "errors/errors.hpp"
#include "rpc/tls.hpp"

namespace anticrack::app {
namespace {

namespace fs = std::filesystem;

constexpr int warn_days = 14;

access::TokenTable load_tokens(const std::string& path) {
  const std::string text = read_guarded_file("tokens", path, OthersMay::read);
  access::TokenTable tokens = access::TokenTable::parse(text, path);
  // An empty table would let everyone in.
  if (tokens.empty()) {
    throw ConfigError("tokens: " + path +
                      " holds no token; make one with deploy/make-certificates");
  }
  return tokens;
}

struct ReadFiles {
  rpc::Tls tls;
  std::optional<int> days_left;  ///< until the certificate expires
  access::TokenTable tokens;
};

/// Runs a check of a file; its errors become a ConfigError with the name of the key.
void as_config_error(const std::function<void()>& check) {
  try {
    check();
  } catch (const errors::Error& error) {
    throw ConfigError((error.fields().empty() ? "" : error.fields().front().field + ": ") +
                      error.what());
  }
}

/// Reads and checks every file that the configuration names. `attempt` runs a check: at a start the
/// first bad file throws, --check-config goes on.
ReadFiles read_files(const Config& config,
                     const std::function<void(const std::function<void()>&)>& attempt) {
  ReadFiles files;
  auto& [certificate, key, roots] = files.tls;
  const auto read = [&](const char* name, const std::string& path, OthersMay others,
                        std::string& to) {
    if (!path.empty()) attempt([&] { to = read_guarded_file(name, path, others); });
  };
  read("tls-certificate", config.tls_certificate, OthersMay::read, certificate);
  read("tls-key", config.tls_key, OthersMay::nothing, key);
  if (!certificate.empty() && !key.empty())
    attempt([&] { files.days_left = rpc::check_certificate(certificate, key); });
  read("tls-client-roots", config.tls_client_roots, OthersMay::read, roots);
  if (!roots.empty()) attempt([&] { rpc::check_roots(roots); });
  if (!config.tokens.empty()) attempt([&] { files.tokens = load_tokens(config.tokens); });
  return files;
}

/// Checks that the folder is writable or, if it does not exist, the one in which it will be made.
void require_writable(const std::string& data) {
  std::error_code code;
  fs::path path = fs::absolute(data).lexically_normal();
  while (path.has_relative_path() && !fs::exists(path, code)) path = path.parent_path();
  const std::string where = "data-dir: " + data + ": ";
  if (!fs::is_directory(path, code))
    throw ConfigError(where + path.string() + " is not a folder; choose another with --data-dir");
  if (::access(path.c_str(), W_OK | X_OK) != 0) {
    throw ConfigError(where + path.string() +
                      " cannot be written: " + std::generic_category().message(errno) +
                      "; give it to the server's user or choose another with --data-dir");
  }
}

}  // namespace

std::vector<std::string> split_names(const std::string& names) {
  std::vector<std::string> result;
  std::istringstream stream(names);
  for (std::string name; std::getline(stream, name, ',');) {
    const std::size_t begin = name.find_first_not_of(' ');
    if (begin == std::string::npos) continue;
    result.push_back(name.substr(begin, name.find_last_not_of(' ') - begin + 1));
  }
  return result;
}

std::vector<std::string> problems_of_files(const Config& config) {
  std::vector<std::string> problems;
  const auto note = [&](const std::function<void()>& check) {
    try {
      as_config_error(check);
    } catch (const ConfigError& error) {
      problems.emplace_back(error.what());
    }
  };
  read_files(config, note);
  note([&] { require_writable(config.store.folder); });
  note([&] { require_mesher(config); });
  return problems;
}

LoadedSecurity load_security(const Config& config) {
  ReadFiles files = read_files(config, as_config_error);
  LoadedSecurity loaded;
  if (has_tls(config)) loaded.security.tls = std::move(files.tls);
  loaded.security.tokens = std::move(files.tokens);
  loaded.security.admins = split_names(config.admins);
  if (files.days_left && *files.days_left < warn_days)
    loaded.warnings.push_back(fmt::format("the certificate expires in {} days", *files.days_left));

  if (is_local(parse_listen_address(config.listen))) return loaded;
  if (config.tokens.empty() && config.tls_client_roots.empty()) {
    loaded.warnings.emplace_back(
        "everyone who reaches this server is an administrator: give tokens or tls-client-roots");
  }
  if (!has_tls(config)) {
    loaded.warnings.emplace_back(
        "nothing is encrypted, not even tokens: give tls-certificate and tls-key");
  }
  return loaded;
}

}  // namespace anticrack::app
