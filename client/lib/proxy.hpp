// SPDX-License-Identifier: GPL-3.0-or-later
//
// Finds the HTTP proxy that gRPC would use, from the environment. For this folder only.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace anticrack::client {

struct Proxy {
  std::string variable;  ///< variable that gives it
  std::string server;    ///< HOST:PORT, without the user and password that the variable may have
};

/// Returns the value of an environment variable; null if it is not set.
using Environment = std::function<const char*(const char*)>;

/// The proxy for a server at `address`: that of grpc_proxy, https_proxy or http_proxy, the first
/// that is set. None if the address is on this machine, or if no_grpc_proxy, no_proxy or NO_PROXY,
/// the first that is set, exempts it: a list, separated by commas, of ends of names, addresses and
/// networks (10.0.0.0/8), each perhaps with a port, or *.
std::optional<Proxy> proxy_for(std::string_view address, const Environment& environment);

}  // namespace anticrack::client
