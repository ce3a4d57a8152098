// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <grpcpp/grpcpp.h>

#include "anticrack/v1/mesh.grpc.pb.h"
#include "records/mesh_record.hpp"
#include "rpc/edge.hpp"

namespace anticrack::rpc {

/// Translates, calls the catalogue, maps the status. See mesh.proto for the methods.
class MeshService final : public v1::MeshService::CallbackService {
 public:
  explicit MeshService(Edge& edge) : _edge(edge) {}

  Unary* CreateMesh(Context* context, const v1::CreateMeshRequest* request,
                    v1::Mesh* response) override;
  Unary* GetMesh(Context* context, const v1::GetMeshRequest* request, v1::Mesh* response) override;
  Unary* ListMeshes(Context* context, const v1::ListMeshesRequest* request,
                    v1::ListMeshesResponse* response) override;
  Answers<v1::ReadMeshResponse>* ReadMesh(Context* context,
                                          const v1::ReadMeshRequest* request) override;
  Unary* DeleteMesh(Context* context, const v1::DeleteMeshRequest* request,
                    google::protobuf::Empty* response) override;
  Unary* WarmMesh(Context* context, const v1::WarmMeshRequest* request,
                  v1::Mesh* response) override;
  Unary* EvictMesh(Context* context, const v1::EvictMeshRequest* request,
                   v1::Mesh* response) override;

 private:
  /// The mesh without its definition.
  v1::Mesh summary(const records::MeshRecord& record) const;
  v1::Mesh to_answer(const records::MeshRecord& record) const;

  Edge& _edge;
};

}  // namespace anticrack::rpc
