// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <grpcpp/grpcpp.h>

#include <chrono>

#include "anticrack/v1/server.grpc.pb.h"
#include "rpc/backend.hpp"
#include "rpc/stream_hub.hpp"

namespace anticrack::rpc {

class ServerService final : public v1::ServerService::CallbackService {
 public:
  ServerService(const Backend& backend, const Limits& limits, const StreamHub& hub);

  grpc::ServerUnaryReactor* GetServerInfo(grpc::CallbackServerContext* context,
                                          const v1::GetServerInfoRequest* request,
                                          v1::ServerInfo* response) override;

 private:
  const Backend _backend;
  const Limits _limits;
  const StreamHub& _hub;
  const std::chrono::system_clock::time_point _start = std::chrono::system_clock::now();
};

}  // namespace anticrack::rpc
