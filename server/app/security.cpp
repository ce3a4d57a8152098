// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/security.hpp"

#include <sstream>

#include "access/tokens.hpp"
#include "app/certificates.hpp"
#include "app/listen_address.hpp"
#include "app/secret_file.hpp"
#include "errors/errors.hpp"

namespace anticrack::app {
namespace {

constexpr int warn_days = 14;

rpc::Tls load_tls(const Config& config, std::vector<std::string>& warnings) {
  rpc::Tls tls;
  tls.certificate = read_guarded_file("tls-certificate", config.tls_certificate, OthersMay::read);
  tls.key = read_guarded_file("tls-key", config.tls_key, OthersMay::nothing);
  const int days = check_certificate(tls.certificate, tls.key);
  if (days < warn_days) {
    warnings.push_back(days < 0 ? std::string("the certificate has expired")
                                : std::string("the certificate expires in ") +
                                      std::to_string(days) + " days");
  }
  if (!config.tls_client_roots.empty()) {
    tls.client_roots =
        read_guarded_file("tls-client-roots", config.tls_client_roots, OthersMay::read);
    check_roots(tls.client_roots);
  }
  return tls;
}

access::TokenTable load_tokens(const std::string& path) {
  const std::string text = read_guarded_file("tokens", path, OthersMay::read);
  access::TokenTable tokens;
  try {
    tokens = access::TokenTable::parse(text, path);
  } catch (const errors::Error& error) {
    throw ConfigError(std::string("tokens: ") + error.what());
  }
  // An empty table would let everyone in.
  if (tokens.empty()) {
    throw ConfigError("tokens: " + path +
                      " holds no token; make one with deploy/make-certificates");
  }
  return tokens;
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

void note_problem(std::vector<std::string>& problems, const std::function<void()>& check) {
  try {
    check();
  } catch (const ConfigError& error) {
    problems.emplace_back(error.what());
  }
}

std::vector<std::string> problems_of_security(const Config& config) {
  std::vector<std::string> problems;
  const auto attempt = [&](const std::string& path, const std::function<void()>& check) {
    if (!path.empty()) note_problem(problems, check);
  };
  const std::string& path = config.tls_certificate;
  std::string certificate, key;
  attempt(path, [&] { certificate = read_guarded_file("tls-certificate", path, OthersMay::read); });
  attempt(config.tls_key,
          [&] { key = read_guarded_file("tls-key", config.tls_key, OthersMay::nothing); });
  attempt(certificate.empty() ? certificate : key, [&] {
    if (check_certificate(certificate, key) < 0)
      throw ConfigError("tls-certificate: " + path +
                        " has expired; renew it: no client would accept it");
  });
  attempt(config.tls_client_roots, [&] {
    check_roots(read_guarded_file("tls-client-roots", config.tls_client_roots, OthersMay::read));
  });
  attempt(config.tokens, [&] { load_tokens(config.tokens); });
  return problems;
}

LoadedSecurity load_security(const Config& config) {
  LoadedSecurity loaded;
  if (has_tls(config)) loaded.security.tls = load_tls(config, loaded.warnings);
  if (!config.tokens.empty()) loaded.security.tokens = load_tokens(config.tokens);
  loaded.security.admins = split_names(config.admins);

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
