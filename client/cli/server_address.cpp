// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/connection_flags.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include "cli/report.hpp"

namespace anticrack::cli {
namespace {

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
    refuse(address, "no host is named; write HOST:PORT, for example localhost" + address);
  if (!is_port(port))
    refuse(address, "\"" + port + "\" is not a port; write a number from 1 to 65535");
}

}  // namespace anticrack::cli
