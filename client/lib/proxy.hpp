// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which HTTP proxy gRPC would use, by the environment. For this folder only.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace anticrack::client {

struct Proxy {
  std::string variable;  ///< that names it
  std::string server;    ///< HOST:PORT, without the user and password that the variable may have
};

/// The value of a variable of the environment; null: not set.
using Environment = std::function<const char*(const char*)>;

/// The proxy of grpc_proxy, https_proxy or http_proxy, the first that is set, for a server at
/// `address`. None for what stays on the machine, and for what no_grpc_proxy, no_proxy or NO_PROXY,
/// the first that is set, exempts: a list, separated by commas, of the ends of names, addresses and
/// networks (10.0.0.0/8), each also with a port, or *.
std::optional<Proxy> proxy_for(std::string_view address, const Environment& environment);

}  // namespace anticrack::client
