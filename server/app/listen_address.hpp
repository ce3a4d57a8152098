// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace anticrack::app {

/// The address at which the server listens.
struct ListenAddress {
  std::string text;         ///< as given
  std::string socket_path;  ///< of unix:PATH, else empty
  std::string host;         ///< of HOST:PORT, brackets removed
  int port = 0;
};

/// Throws std::invalid_argument with one sentence unless `text` is HOST:PORT, [IPV6]:PORT or
/// unix:PATH.
ListenAddress parse_listen_address(const std::string& text);

/// True for unix sockets, 127.0.0.0/8, ::1 and localhost.
bool is_local(const ListenAddress& address);

/// Throws ConfigError unless the address is local or `allow_remote` (TLS, or the user's choice).
void require_local(const ListenAddress& address, bool allow_remote);

/// Removes a unix socket on which no server answers; does nothing for other addresses. Throws
/// ConfigError if a server answers or the path is not a socket.
void clear_stale_socket(const ListenAddress& address);

}  // namespace anticrack::app
