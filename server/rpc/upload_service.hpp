// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <grpcpp/grpcpp.h>

#include "anticrack/v1/upload.grpc.pb.h"
#include "rpc/edge.hpp"

namespace anticrack::rpc {

/// Translates, calls the store, maps the status. See upload.proto for the methods.
class UploadService final : public v1::UploadService::CallbackService {
 public:
  explicit UploadService(Edge& edge) : _edge(edge) {}

  grpc::ServerReadReactor<v1::CreateUploadsRequest>* CreateUploads(
      Context* context, v1::CreateUploadsResponse* response) override;
  Unary* GetUpload(Context* context, const v1::GetUploadRequest* request,
                   v1::Upload* response) override;
  Unary* ListUploads(Context* context, const v1::ListUploadsRequest* request,
                     v1::ListUploadsResponse* response) override;
  Unary* DeleteUpload(Context* context, const v1::DeleteUploadRequest* request,
                      google::protobuf::Empty* response) override;

 private:
  Edge& _edge;
};

}  // namespace anticrack::rpc
