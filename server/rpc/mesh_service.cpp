// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/mesh_service.hpp"

#include <memory>

#include "api/names.hpp"
#include "api/requests.hpp"
#include "api/translations.hpp"
#include "meshes/mesh_catalogue.hpp"
#include "rpc/block_feed.hpp"
#include "rpc/from_domain.hpp"
#include "rpc/pages.hpp"
#include "rpc/unary.hpp"
#include "rpc/visible.hpp"
#include "rpc/write_stream.hpp"

namespace anticrack::rpc {

using access::Identity;
using errors::Error;
using errors::Reason;

v1::Mesh MeshService::summary(const records::MeshRecord& record) const {
  return from_domain(record, _edge.backend.catalogue.pinned(record.id));
}

v1::Mesh MeshService::to_answer(const records::MeshRecord& record) const {
  v1::Mesh mesh = summary(record);
  api::write_definition(record.definition, mesh);
  return mesh;
}

Unary* MeshService::CreateMesh(Context* context, const v1::CreateMeshRequest* request,
                               v1::Mesh* response) {
  return create(_edge, context, *request, [this, request, response](const Identity& who) {
    _edge.admission.require_open();
    const records::MeshDefinition definition = api::to_definition(*request);
    try {
      *response = to_answer(_edge.backend.catalogue.create(definition, request->title(), who.name,
                                                           request->for_job()));
    } catch (const Error& error) {
      const bool about_file = error.fields().empty() && error.reason() == Reason::mesh_invalid;
      throw api::below_mesh_request(about_file ? Error(error).at("upload") : error);
    }
  });
}

Unary* MeshService::GetMesh(Context* context, const v1::GetMeshRequest* request,
                            v1::Mesh* response) {
  return look_up(_edge, context, *request, [this, request, response](const Identity& who) {
    *response = to_answer(visible_mesh(_edge.backend, who, api::mesh_id(request->name(), "name")));
  });
}

Unary* MeshService::ListMeshes(Context* context, const v1::ListMeshesRequest* request,
                               v1::ListMeshesResponse* response) {
  return look_up(_edge, context, *request, [this, request, response](const Identity& who) {
    response->set_next_page_token(fill_page(
        to_page(request->page_size(), request->page_token()),
        [&](const std::string& after, std::size_t count) {
          return _edge.backend.catalogue.list({after, count, owner_filter(who, request->owner())});
        },
        [&](const records::MeshRecord& record) {
          return (*response->add_meshes() = summary(record)).ByteSizeLong();
        }));
  });
}

Answers<v1::ReadMeshResponse>* MeshService::ReadMesh(Context* context,
                                                     const v1::ReadMeshRequest* request) {
  return stream<v1::ReadMeshResponse>(
      _edge, context, StreamKind::transfer, *request, [this, request](const Identity& who) {
        const std::string id = api::mesh_id(request->name(), "name");
        visible_mesh(_edge.backend, who, id);
        return std::make_unique<BlockFeed<v1::ReadMeshResponse>>(_edge.backend.catalogue.read(id),
                                                                 request->offset());
      });
}

Unary* MeshService::DeleteMesh(Context* context, const v1::DeleteMeshRequest* request,
                               google::protobuf::Empty* /*response*/) {
  return change(_edge, context, *request, [this, request](const Identity& who) {
    const std::string id = api::mesh_id(request->name(), "name");
    visible_mesh(_edge.backend, who, id);
    _edge.backend.catalogue.erase(id);
  });
}

Unary* MeshService::WarmMesh(Context* context, const v1::WarmMeshRequest* request,
                             v1::Mesh* response) {
  return change(_edge, context, *request, [this, request, response](const Identity& who) {
    _edge.admission.require_open();
    if (request->pin()) access::require_admin(who, "pin a mesh in memory");
    const std::string id = api::mesh_id(request->name(), "name");
    visible_mesh(_edge.backend, who, id);
    *response = to_answer(_edge.backend.catalogue.warm(id, request->pin()));
  });
}

Unary* MeshService::EvictMesh(Context* context, const v1::EvictMeshRequest* request,
                              v1::Mesh* response) {
  return change(_edge, context, *request, [this, request, response](const Identity& who) {
    access::require_admin(who, "evict a mesh");
    const std::string id = api::mesh_id(request->name(), "name");
    visible_mesh(_edge.backend, who, id);
    *response = to_answer(_edge.backend.catalogue.evict(id));
  });
}

}  // namespace anticrack::rpc
