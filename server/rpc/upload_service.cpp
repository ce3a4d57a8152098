// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/upload_service.hpp"

#include "api/names.hpp"
#include "errors/errors.hpp"
#include "jobs/job_engine.hpp"
#include "rpc/from_domain.hpp"
#include "rpc/pages.hpp"
#include "rpc/unary.hpp"
#include "rpc/upload_stream.hpp"
#include "rpc/visible.hpp"
#include "store/store.hpp"

namespace anticrack::rpc {

using access::Identity;

grpc::ServerReadReactor<v1::CreateUploadsRequest>* UploadService::CreateUploads(
    Context* context, v1::CreateUploadsResponse* response) {
  return receive_upload(_edge, context, response);
}

Unary* UploadService::GetUpload(Context* context, const v1::GetUploadRequest* request,
                                v1::Upload* response) {
  return look_up(_edge, context, *request, [this, request, response](const Identity& who) {
    const std::string sha256 = api::upload_sha256(request->name(), "name");
    const auto record = _edge.backend.store.upload(sha256, who.name);
    if (!record) {
      throw errors::Error(errors::Reason::not_found, "there is no {}", api::upload_name(sha256));
    }
    *response = from_domain(*record, _edge.backend.engine.options().upload_ttl);
  });
}

Unary* UploadService::ListUploads(Context* context, const v1::ListUploadsRequest* request,
                                  v1::ListUploadsResponse* response) {
  return look_up(_edge, context, *request, [this, request, response](const Identity& who) {
    const std::string owner = owner_filter(who, request->owner()).value_or(who.name);
    response->set_next_page_token(fill_page(
        to_page(request->page_size(), request->page_token()),
        [&](const std::string& after, std::size_t count) {
          return _edge.backend.store.uploads(owner, after, count);
        },
        [&](const store::UploadRecord& record) {
          return (*response->add_uploads() =
                      from_domain(record, _edge.backend.engine.options().upload_ttl))
              .ByteSizeLong();
        }));
  });
}

Unary* UploadService::DeleteUpload(Context* context, const v1::DeleteUploadRequest* request,
                                   google::protobuf::Empty* /*response*/) {
  return change(_edge, context, *request, [this, request](const Identity& who) {
    _edge.backend.store.erase_upload(api::upload_sha256(request->name(), "name"), who.name);
  });
}

}  // namespace anticrack::rpc
