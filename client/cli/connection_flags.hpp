// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which server, by what it is known, who asks, and for how long a lost one is waited for: the
// options of every command that talks to a server.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "client/connection.hpp"
#include "client/credentials.hpp"
#include "client/error.hpp"

namespace CLI {
class App;
}

namespace anticrack::cli {

struct ConnectionFlags {
  std::string server;  ///< empty: client::default_address
  client::CredentialFiles credentials;
  std::optional<std::chrono::milliseconds> retry_for;
};

/// The flags, and the variables of the environment that stand in for them.
void add_connection_flags(CLI::App& app, ConnectionFlags& flags);

/// Reads the files. `notice` as in ConnectionOptions. Throws client::Error.
client::ConnectionOptions connection_options(const ConnectionFlags& flags,
                                             std::function<void(const std::string&)> notice);

/// The flags again, to be put at the end of a shell's command line; empty where none was given.
std::string as_flags(const ConnectionFlags& flags);

}  // namespace anticrack::cli
