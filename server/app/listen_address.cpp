// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/listen_address.hpp"

#include <arpa/inet.h>
#include <fmt/core.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "app/config.hpp"
#include "app/values.hpp"

namespace anticrack::app {
namespace {

ListenAddress parse_socket(const std::string& text) {
  ListenAddress address{text, text.substr(5), {}, 0};
  const std::size_t limit = sizeof(sockaddr_un::sun_path) - 1;
  if (address.socket_path.empty() || address.socket_path.size() > limit) {
    throw std::invalid_argument(
        fmt::format("\"{}\": the path of a unix socket has 1 to {} bytes", text, limit));
  }
  return address;
}

bool in_use(const std::string& path) {
  const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (socket < 0)
    throw ConfigError("cannot make a socket: " + std::generic_category().message(errno));
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  std::memcpy(name.sun_path, path.c_str(), path.size() + 1);
  const int connected = ::connect(socket, reinterpret_cast<const sockaddr*>(&name), sizeof(name));
  const bool refused = connected != 0 && errno == ECONNREFUSED;
  ::close(socket);
  return !refused;  // if in doubt, it counts as in use
}

}  // namespace

ListenAddress parse_listen_address(const std::string& text) {
  if (text.starts_with("unix:")) return parse_socket(text);
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0)
    throw std::invalid_argument("\"" + text + "\" is neither HOST:PORT nor unix:PATH");
  std::string host = text.substr(0, colon);
  const bool bracketed = host.starts_with('[') && host.ends_with(']');
  if (bracketed) host = host.substr(1, host.size() - 2);
  if (host.empty() || host.find_first_of("[]/ ") != std::string::npos ||
      (!bracketed && host.find(':') != std::string::npos))
    throw std::invalid_argument("\"" + text + "\" is neither HOST:PORT, [IPV6]:PORT nor unix:PATH");
  const auto port = static_cast<int>(to_integer(text.substr(colon + 1), 0, 65'535));
  return {text, {}, host, port};
}

bool is_local(const ListenAddress& address) {
  if (!address.socket_path.empty() || address.host == "localhost") return true;
  in_addr v4{};
  if (::inet_pton(AF_INET, address.host.c_str(), &v4) == 1) return ntohl(v4.s_addr) >> 24 == 127;
  in6_addr v6{};
  return ::inet_pton(AF_INET6, address.host.c_str(), &v6) == 1 && IN6_IS_ADDR_LOOPBACK(&v6);
}

void require_local(const ListenAddress& address, bool allow_remote) {
  if (allow_remote || is_local(address)) return;
  throw ConfigError(
      "listen: " + address.text +
      " is reachable from other machines, and nothing would be encrypted: give tls-certificate and "
      "tls-key (deploy/make-certificates makes test certificates), use a loopback address or "
      "unix:PATH, or accept this with --allow-insecure-remote");
}

void clear_stale_socket(const ListenAddress& address) {
  if (address.socket_path.empty()) return;
  const std::string& path = address.socket_path;
  struct stat found {};
  if (::lstat(path.c_str(), &found) != 0) return;
  if (!S_ISSOCK(found.st_mode))
    throw ConfigError("listen: " + path + " exists and is not a socket; choose another path");
  if (in_use(path)) {
    throw ConfigError("listen: another server answers on " + path +
                      "; stop it or choose another path");
  }
  if (::unlink(path.c_str()) != 0) {
    throw ConfigError("listen: cannot remove the stale socket " + path + ": " +
                      std::generic_category().message(errno));
  }
}

}  // namespace anticrack::app
