// SPDX-License-Identifier: GPL-3.0-or-later
#include "client/proxy.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <initializer_list>
#include <system_error>

#include "client/credentials.hpp"

namespace anticrack::client {
namespace {

struct HostPort {
  std::string host;
  std::string port;  ///< empty: none
};

/// Splits HOST, HOST:PORT, [IPV6]:PORT or IPV6, in lower case.
HostPort split(std::string_view text) {
  const std::string all = plain_address(text);
  if (all.starts_with('[')) {
    const std::size_t end = std::min(all.find(']'), all.size());
    const std::size_t port = all.find(':', end);
    return {all.substr(1, end - 1), port == std::string::npos ? "" : all.substr(port + 1)};
  }
  const std::size_t colon = all.find(':');
  if (colon == std::string::npos || all.find(':', colon + 1) != std::string::npos) return {all, ""};
  return {all.substr(0, colon), all.substr(colon + 1)};
}

/// An address in IPv6, of which IPv4 addresses are a part.
using Ip = std::array<std::uint8_t, 16>;

std::optional<Ip> ip_of(const std::string& host) {
  constexpr std::size_t before_v4 = 12;
  Ip ip{};
  if (inet_pton(AF_INET6, host.c_str(), ip.data()) == 1) return ip;
  ip = {};
  ip[10] = ip[11] = 0xff;
  if (inet_pton(AF_INET, host.c_str(), ip.data() + before_v4) == 1) return ip;
  return std::nullopt;
}

/// Whether the network of a text like "10.0.0.0/8" has the address; none if the text is no network.
std::optional<bool> network_has(const std::string& text, const std::optional<Ip>& ip) {
  const std::size_t slash = std::min(text.find('/'), text.size());
  const std::string host = text.substr(0, slash);
  const auto first = ip_of(host);
  const bool v6 = host.find(':') != std::string::npos;
  std::size_t bits = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(std::min(text.data() + slash + 1, last), last, bits);
  if (!first || error != std::errc() || end != last || bits > (v6 ? 128 : 32)) return std::nullopt;
  for (std::size_t bit = 0; ip && bit < bits + (v6 ? 0 : 96); ++bit)
    if ((((*first)[bit / 8] ^ (*ip)[bit / 8]) << (bit % 8) & 0x80) != 0) return false;
  return ip.has_value();
}

bool exempts(std::string_view entry, const HostPort& server) {
  while (!entry.empty() && std::isspace(static_cast<unsigned char>(entry.front())) != 0)
    entry.remove_prefix(1);
  while (!entry.empty() && std::isspace(static_cast<unsigned char>(entry.back())) != 0)
    entry.remove_suffix(1);
  if (entry == "*") return true;
  const auto ip = ip_of(server.host);
  if (const auto inside = network_has(plain_address(entry), ip)) return *inside;
  if (entry.starts_with("*.")) entry.remove_prefix(1);
  const HostPort wanted = split(entry);
  if (wanted.host.empty() || (!wanted.port.empty() && wanted.port != server.port)) return false;
  if (const auto other = ip_of(wanted.host)) return ip == other;
  return server.host.ends_with(wanted.host) || "." + server.host == wanted.host;
}

bool exempt(std::string_view list, const HostPort& server) {
  while (!list.empty()) {
    const std::size_t comma = std::min(list.find(','), list.size());
    if (exempts(list.substr(0, comma), server)) return true;
    list.remove_prefix(std::min(comma + 1, list.size()));
  }
  return false;
}

std::string without_password(std::string_view url) {
  if (const std::size_t scheme = url.find("://"); scheme != std::string_view::npos)
    url.remove_prefix(scheme + 3);
  url = url.substr(0, url.find('/'));
  if (const std::size_t user = url.rfind('@'); user != std::string_view::npos)
    url.remove_prefix(user + 1);
  return std::string(url);
}

/// The first of the variables that is set.
const char* first_set(std::initializer_list<const char*> names, const Environment& environment) {
  for (const char* name : names)
    if (environment(name) != nullptr) return name;
  return nullptr;
}

}  // namespace

std::optional<Proxy> proxy_for(std::string_view address, const Environment& environment) {
  const char* name = first_set({"grpc_proxy", "https_proxy", "http_proxy"}, environment);
  if (name == nullptr || *environment(name) == '\0' || is_loopback(address)) return std::nullopt;
  const char* exemptions = first_set({"no_grpc_proxy", "no_proxy", "NO_PROXY"}, environment);
  if (exemptions != nullptr && exempt(environment(exemptions), split(address))) return std::nullopt;
  return Proxy{name, without_password(environment(name))};
}

}  // namespace anticrack::client
