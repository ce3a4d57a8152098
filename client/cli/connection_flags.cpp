// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/connection_flags.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "cli/report.hpp"
#include "words/duration.hpp"

namespace anticrack::cli {
namespace {

// The word in quotes if a shell needs them to read it back.
std::string quoted_if_needed(const std::string& word) {
  const bool plain = word.find_first_not_of(
                         "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                         "0123456789-_./:@%+=,") == std::string::npos;
  if (plain) return word;
  std::string result = "'";
  for (const char c : word) result += c == '\'' ? "'\\''" : std::string(1, c);
  return result + "'";
}

[[noreturn]] void refuse(const std::string& address, const std::string& problem) {
  throw UsageError("--server " + address + ": " + problem);
}

bool has_scheme(std::string_view address) {
  constexpr std::array<std::string_view, 5> schemes{
      "unix:", "unix-abstract:", "dns:", "ipv4:", "ipv6:"};
  return std::any_of(schemes.begin(), schemes.end(),
                     [&](std::string_view scheme) { return address.starts_with(scheme); });
}

bool is_port(std::string_view text) {
  unsigned port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  return error == std::errc() && end == text.data() + text.size() && port >= 1 && port <= 65535;
}

}  // namespace

void add_connection_flags(CLI::App& app, ConnectionFlags& flags) {
  app.add_option("--server", flags.server,
                 "HOST:PORT or unix:PATH of anticrackd (default: 127.0.0.1:7433)")
      ->type_name("ADDRESS")
      ->envname("ANTICRACK_SERVER");
  app.add_flag("--tls", flags.credentials.tls,
               "Encrypt, and know the server by the roots of this system");
  const auto add_file = [&app](const char* flag, std::filesystem::path& path, const char* variable,
                               const char* help) {
    app.add_option(flag, path, help)->type_name("FILE")->envname(variable);
  };
  add_file("--ca", flags.credentials.ca, "ANTICRACK_CA",
           "Encrypt, and know the server by this authority's certificate, PEM");
  add_file("--cert", flags.credentials.certificate, "ANTICRACK_CERT",
           "Certificate of this client, PEM; for servers that want one");
  add_file("--key", flags.credentials.key, "ANTICRACK_KEY", "Private key of --cert, PEM");
  add_file("--token-file", flags.credentials.token, "ANTICRACK_TOKEN_FILE",
           "Holds the token of this client; the variable ANTICRACK_TOKEN may hold it instead");
  app.add_option_function<std::string>(
         "--retry-for",
         [&flags](const std::string& text) {
           flags.retry_for = words::parse_duration(text);
           if (!flags.retry_for) {
             throw CLI::ValidationError("--retry-for",
                                        text + " is not a time; write 30s, 10min or 2h");
           }
         },
         "How long a server that is gone is tried again (default: 5min, 3s if it was never there)")
      ->type_name("TIME");
}

client::ConnectionOptions connection_options(const ConnectionFlags& flags,
                                             std::function<void(const std::string&)> notice) {
  client::ConnectionOptions options;
  if (!flags.server.empty()) {
    check_server_address(flags.server);
    options.address = flags.server;
  }
  client::CredentialFiles files = flags.credentials;
  if (const char* token = std::getenv("ANTICRACK_TOKEN")) files.token_text = token;
  options.credentials = client::read_credentials(files, options.address);
  if (flags.retry_for) {
    options.retry.patience = *flags.retry_for;
    options.first_contact = *flags.retry_for;
  }
  options.notice = std::move(notice);
  return options;
}

std::string as_flags(const ConnectionFlags& flags) {
  const client::CredentialFiles& files = flags.credentials;
  std::string text = flags.server.empty() ? "" : " --server " + quoted_if_needed(flags.server);
  text += files.tls ? " --tls" : "";
  const auto add = [&text](const char* flag, const std::filesystem::path& path) {
    text += path.empty() ? std::string()
                         : std::string(" ") + flag + " " + quoted_if_needed(path.string());
  };
  add("--ca", files.ca);
  add("--cert", files.certificate);
  add("--key", files.key);
  add("--token-file", files.token);
  return text;
}

void check_server_address(const std::string& address) {
  if (has_scheme(address)) return;
  if (address.find('/') != std::string::npos)
    refuse(address, "no address of a server; write HOST:PORT, or unix:PATH for a socket");
  const std::size_t colon = address.rfind(':');
  const std::string host = address.substr(0, colon);
  const bool bare = host.find(':') != std::string::npos && host.back() != ']';  // IPv6
  if (colon == std::string::npos || bare || address.back() == ']') {
    refuse(address, "no port is named; write HOST:PORT, for example " +
                        (bare && address.back() != ']' ? "[" + address + "]" : address) + ":7433");
  }
  const std::string port = address.substr(colon + 1);
  if (host.empty())
    refuse(address, "no host is named; write HOST:PORT, for example 127.0.0.1" + address);
  if (!is_port(port))
    refuse(address, "\"" + port + "\" is not a port; write a number from 1 to 65535");
}

}  // namespace anticrack::cli
