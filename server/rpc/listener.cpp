// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/listener.hpp"

#include <fmt/core.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include "errors/errors.hpp"

namespace anticrack::rpc {
namespace {

struct Address {
  sockaddr_storage bytes{};
  socklen_t size = 0;
};

/// Throws the error for an address that cannot be used. `number`: an errno.
[[noreturn]] void refuse(const std::string& listen, int number) {
  const bool elsewhere = number == EADDRINUSE || number == EADDRNOTAVAIL || number == 0;
  throw errors::Error(errors::Reason::invalid_argument,
                      "cannot listen on {}: {}; choose another (port 0 picks a free one)", listen,
                      elsewhere ? "the address is taken or not one of this machine"
                                : std::generic_category().message(number))
      .at("listen");
}

sockaddr* as_socket_address(Address& address) {
  return reinterpret_cast<sockaddr*>(&address.bytes);
}

template <class Kind>
Kind& as(Address& address) {
  return reinterpret_cast<Kind&>(address.bytes);
}

template <class Kind>
Address make_address(const Kind& kind) {
  Address address;
  std::memcpy(&address.bytes, &kind, sizeof(kind));
  address.size = sizeof(kind);
  return address;
}

void set_port(Address& address, in_port_t port) {
  if (address.bytes.ss_family == AF_INET6)
    as<sockaddr_in6>(address).sin6_port = port;
  else
    as<sockaddr_in>(address).sin_port = port;
}

in_port_t port_of(const base::Descriptor& socket) {
  Address address;
  address.size = sizeof(address.bytes);
  ::getsockname(socket.get(), as_socket_address(address), &address.size);
  return address.bytes.ss_family == AF_INET6 ? as<sockaddr_in6>(address).sin6_port
                                             : as<sockaddr_in>(address).sin_port;
}

bool is_any(Address& address) {
  if (address.bytes.ss_family == AF_INET6)
    return IN6_IS_ADDR_UNSPECIFIED(&as<sockaddr_in6>(address).sin6_addr);
  return as<sockaddr_in>(address).sin_addr.s_addr == INADDR_ANY;
}

/// A listening socket; on failure -1, with errno set.
base::Descriptor listening(Address& address) {
  const int family = address.bytes.ss_family;
  base::Descriptor socket(::socket(family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!socket) return socket;
  const int on = 1;
  const int off = 0;
  // SO_REUSEPORT is not set, as a second server on the port would start and take half of the calls.
  if (family != AF_UNIX) ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  if (family == AF_INET6) ::setsockopt(socket.get(), IPPROTO_IPV6, IPV6_V6ONLY, &off, sizeof(off));
  if (::bind(socket.get(), as_socket_address(address), address.size) == 0 &&
      ::listen(socket.get(), SOMAXCONN) == 0)
    return socket;
  const int number = errno;
  { const base::Descriptor closed = std::move(socket); }
  errno = number;
  return base::Descriptor();
}

std::vector<Address> resolve(const std::string& listen) {
  const std::size_t colon = listen.rfind(':');
  std::string host = listen.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  // Uses the number, as a machine need not have /etc/hosts and no name is looked up.
  if (host == "localhost") host = "127.0.0.1";
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* list = nullptr;
  if (colon == std::string::npos ||
      ::getaddrinfo(host.c_str(), listen.c_str() + colon + 1, &hints, &list) != 0)
    refuse(listen, 0);
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owned(list, ::freeaddrinfo);
  std::vector<Address> found;
  for (const addrinfo* entry = list; entry != nullptr; entry = entry->ai_next) {
    Address& address = found.emplace_back();
    std::memcpy(&address.bytes, entry->ai_addr, entry->ai_addrlen);
    address.size = entry->ai_addrlen;
  }
  return found;
}

/// Listens on both families, with one socket if the machine has IPv6.
std::vector<base::Descriptor> listen_to_all(Address given) {
  sockaddr_in6 six{};
  six.sin6_family = AF_INET6;
  six.sin6_port = given.bytes.ss_family == AF_INET6 ? as<sockaddr_in6>(given).sin6_port
                                                    : as<sockaddr_in>(given).sin_port;
  sockaddr_in four{};
  four.sin_family = AF_INET;
  four.sin_port = six.sin6_port;
  std::vector<base::Descriptor> sockets;
  for (Address address : {make_address(six), make_address(four)}) {
    base::Descriptor socket = listening(address);
    const bool family_is_missing = !socket && (errno == EAFNOSUPPORT || errno == EADDRNOTAVAIL);
    if (socket) sockets.push_back(std::move(socket));
    if (!family_is_missing) break;
  }
  return sockets;
}

std::vector<base::Descriptor> listen_to(const std::string& listen) {
  std::vector<base::Descriptor> sockets;
  in_port_t port = 0;
  int number = 0;
  for (Address address : resolve(listen)) {
    if (is_any(address)) {
      sockets = listen_to_all(address);
      if (sockets.empty()) number = errno;
      break;
    }
    if (port != 0) set_port(address, port);
    base::Descriptor socket = listening(address);
    if (!socket) {
      number = errno;
      continue;
    }
    port = port_of(socket);
    sockets.push_back(std::move(socket));
  }
  if (sockets.empty()) refuse(listen, number);
  return sockets;
}

}  // namespace

Listener::Listener(const std::string& listen) {
  constexpr std::string_view scheme = "unix:";
  if (!listen.starts_with(scheme)) {
    _sockets = listen_to(listen);
    const std::size_t colon = listen.rfind(':');
    const std::string host = listen.substr(0, colon);
    _address = fmt::format("{}:{}", host == "localhost" ? "127.0.0.1" : host,
                           ntohs(port_of(_sockets.front())));
    return;
  }
  const std::string path = listen.substr(scheme.size());
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  if (path.size() >= sizeof(name.sun_path)) refuse(listen, ENAMETOOLONG);
  std::memcpy(name.sun_path, path.c_str(), path.size() + 1);
  Address address = make_address(name);
  base::Descriptor socket = listening(address);
  if (!socket) refuse(listen, errno);
  _sockets.push_back(std::move(socket));
  _address = listen;
  struct stat found {};
  if (::lstat(path.c_str(), &found) != 0) refuse(listen, errno);
  _path = path;
  _inode = found.st_ino;
}

Listener::~Listener() {
  struct stat found {};
  // Another server may have put its own socket there meanwhile.
  if (!_path.empty() && ::lstat(_path.c_str(), &found) == 0 && found.st_ino == _inode)
    ::unlink(_path.c_str());
}

}  // namespace anticrack::rpc
