// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/mesh_service.hpp"

#include <memory>

#include "meshes/mesh_catalogue.hpp"
#include "rpc/block_feed.hpp"
#include "rpc/from_domain.hpp"
#include "rpc/names.hpp"
#include "rpc/pages.hpp"
#include "rpc/to_domain.hpp"
#include "rpc/upload_stream.hpp"
#include "rpc/write_stream.hpp"

namespace anticrack::rpc {
namespace {

using errors::Error;
using errors::Reason;

grpc::ServerUnaryReactor* refuse(grpc::CallbackServerContext* context, const char* method) {
  return answer(context, method, [method] {
    throw Error(Reason::not_implemented,
                std::string(method) + " is not in this version; GetServerInfo lists what is")
        .at("name")
        .with("method", method);
  });
}

}  // namespace

MeshService::MeshService(const Backend& backend, const Limits& limits, const Admission& admission,
                         StreamHub& hub, WorkThread& work)
    : _backend(backend), _limits(limits), _admission(admission), _hub(hub), _work(work) {}

grpc::ServerReadReactor<v1::UploadMeshRequest>* MeshService::UploadMesh(
    grpc::CallbackServerContext* /*context*/, v1::UploadMeshResponse* response) {
  return receive_upload(_hub, _work, _backend.store, _limits.upload_bytes, response);
}

grpc::ServerUnaryReactor* MeshService::CreateMesh(grpc::CallbackServerContext* context,
                                                  const v1::CreateMeshRequest* request,
                                                  v1::Mesh* response) {
  const auto limit = static_cast<std::size_t>(_limits.waiting_creations);
  return answer_on(_work, limit, context, "CreateMesh", [this, request, response] {
    _admission.require_open();
    const store::MeshDefinition definition = to_definition(*request);
    try {
      *response = from_domain(_backend.catalogue.create(definition, request->title()));
    } catch (const Error& error) {
      const bool about_file = error.fields().empty() && error.reason() == Reason::mesh_invalid;
      throw below_mesh_request(about_file ? Error(error).at("upload") : error);
    }
  });
}

grpc::ServerUnaryReactor* MeshService::GetMesh(grpc::CallbackServerContext* context,
                                               const v1::GetMeshRequest* request,
                                               v1::Mesh* response) {
  return answer(context, "GetMesh", [&] {
    *response = from_domain(_backend.catalogue.get(mesh_id(request->name(), "name")));
  });
}

grpc::ServerUnaryReactor* MeshService::ListMeshes(grpc::CallbackServerContext* context,
                                                  const v1::ListMeshesRequest* request,
                                                  v1::ListMeshesResponse* response) {
  return answer(context, "ListMeshes", [&] {
    response->set_next_page_token(fill_page(
        to_page(request->page_size(), request->page_token()),
        [&](const std::string& after, std::size_t count) {
          return _backend.catalogue.list(after, count);
        },
        [&](const store::MeshRecord& record) {
          return (*response->add_meshes() = from_domain(record)).ByteSizeLong();
        }));
  });
}

grpc::ServerWriteReactor<v1::ReadMeshResponse>* MeshService::ReadMesh(
    grpc::CallbackServerContext* context, const v1::ReadMeshRequest* request) {
  return stream<v1::ReadMeshResponse>(context, _hub, StreamKind::transfer, "ReadMesh", [&] {
    return std::make_unique<BlockFeed<v1::ReadMeshResponse>>(
        _backend.catalogue.read(mesh_id(request->name(), "name")), request->offset());
  });
}

grpc::ServerUnaryReactor* MeshService::DeleteMesh(grpc::CallbackServerContext* context,
                                                  const v1::DeleteMeshRequest* /*request*/,
                                                  google::protobuf::Empty* /*response*/) {
  return refuse(context, "DeleteMesh");
}

grpc::ServerUnaryReactor* MeshService::WarmMesh(grpc::CallbackServerContext* context,
                                                const v1::WarmMeshRequest* /*request*/,
                                                v1::Mesh* /*response*/) {
  return refuse(context, "WarmMesh");
}

grpc::ServerUnaryReactor* MeshService::EvictMesh(grpc::CallbackServerContext* context,
                                                 const v1::EvictMeshRequest* /*request*/,
                                                 v1::Mesh* /*response*/) {
  return refuse(context, "EvictMesh");
}

}  // namespace anticrack::rpc
