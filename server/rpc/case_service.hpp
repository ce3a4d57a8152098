// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <grpcpp/grpcpp.h>

#include "anticrack/v1/case.grpc.pb.h"
#include "rpc/edge.hpp"

namespace anticrack::rpc {

/// Passes on to casefile. See case.proto for the methods.
class CaseService final : public v1::CaseService::CallbackService {
 public:
  explicit CaseService(Edge& edge) : _edge(edge) {}

  Unary* ReadCase(Context* context, const v1::ReadCaseRequest* request,
                  v1::ReadCaseResponse* response) override;
  Unary* ListCaseKeys(Context* context, const v1::ListCaseKeysRequest* request,
                      v1::ListCaseKeysResponse* response) override;

 private:
  Edge& _edge;
};

}  // namespace anticrack::rpc
