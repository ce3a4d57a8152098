// SPDX-License-Identifier: GPL-3.0-or-later
//
// The options of every command that talks to a server: address, credentials, retries.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "client/connection.hpp"
#include "client/credentials.hpp"

namespace CLI {
class App;
}

namespace anticrack::cli {

struct ConnectionFlags {
  std::string server;  ///< empty: client::default_address
  client::CredentialFiles credentials;
  std::optional<std::chrono::milliseconds> retry_for;
};

/// The flags, and the environment variables that replace them.
void add_connection_flags(CLI::App& app, ConnectionFlags& flags);

/// Reads the files. `notice`: as in ConnectionOptions. Throws client::Error.
client::ConnectionOptions connection_options(const ConnectionFlags& flags,
                                             std::function<void(const std::string&)> notice);

/// The flags as they were given, for the end of a command line; may be empty.
std::string as_flags(const ConnectionFlags& flags);

/// Throws UsageError unless the address is HOST:PORT or has a scheme of gRPC, like unix:PATH, since
/// gRPC would silently use another port.
void check_server_address(const std::string& address);

}  // namespace anticrack::cli
