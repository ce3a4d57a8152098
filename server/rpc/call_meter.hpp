// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <grpcpp/support/server_interceptor.h>

#include <memory>
#include <vector>

#include "rpc/server.hpp"

namespace anticrack::rpc {

/// Makes gRPC tell `listener` of the end of every call, just before the status is sent, including
/// health, reflection and calls that are refused before a method runs. Empty if there is no
/// listener.
std::vector<std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>> call_meters(
    const CallListener& listener);

}  // namespace anticrack::rpc
