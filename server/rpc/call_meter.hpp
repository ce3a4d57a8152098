// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <grpcpp/support/server_interceptor.h>

#include <memory>
#include <vector>

#include "rpc/server.hpp"

namespace anticrack::rpc {

/// Has gRPC tell `listener` of every call it hands its end to, health, reflection and what is
/// refused before a method runs included, just before the status is sent. None where there is no
/// listener.
std::vector<std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>> call_meters(
    const CallListener& listener);

}  // namespace anticrack::rpc
