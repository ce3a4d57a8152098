// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <string>
#include <vector>

#include "anticrack/v1/server.grpc.pb.h"
#include "rpc/edge.hpp"

namespace anticrack::rpc {

class ServerService final : public v1::ServerService::CallbackService {
 public:
  /// `security` decides which security features are listed.
  ServerService(const Edge& edge, const Security& security);

  Unary* GetServerInfo(Context* context, const v1::GetServerInfoRequest* request,
                       v1::ServerInfo* response) override;

 private:
  const Edge& _edge;
  std::vector<std::string> _features;
  const std::chrono::system_clock::time_point _start = std::chrono::system_clock::now();
};

}  // namespace anticrack::rpc
