// SPDX-License-Identifier: GPL-3.0-or-later
//
// Every unary request as it comes from the wire: the first byte chooses the message, the rest are
// its bytes. What a handler does with it before it waits for anything is done: translation, the
// plan of a geometry, the check of loads and solver, and what the store keeps of it. The same
// request with an unknown field in one of its messages must be refused.
#include <google/protobuf/message.h>
#include <google/protobuf/unknown_field_set.h>

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "anticrack/v1/mesh.pb.h"
#include "anticrack/v1/solve.pb.h"
#include "api/names.hpp"
#include "api/requests.hpp"
#include "api/unknown_fields.hpp"
#include "errors/errors.hpp"
#include "fem/load.hpp"
#include "fuzz/input.hpp"
#include "fuzz/quiet_protobuf.hpp"
#include "mesh/codec.hpp"
#include "records/case_record.hpp"
#include "records/job_record.hpp"
#include "records/mesh_record.hpp"
#include "rpc/pages.hpp"
#include "store/record_codec.hpp"

namespace {

using namespace anticrack;

constexpr std::size_t max_triangles = 10'000;
constexpr std::size_t max_expression_bytes = 4'096;

template <class Record, class Decode>
void check_record(const Record& record, const Decode& decode) {
  const std::string bytes = store::encode(record);
  fuzz::require(store::encode(decode(bytes)) == bytes, "the record comes back as another");
}

void plan(const records::GeometrySource& source) {
  mesh::MesherRequest request = mesh::GenerateRequest{
      mesh::plan(source.geometry, source.options, max_triangles), max_triangles};
  const mesh::Bytes bytes = mesh::encode(request);
  fuzz::require(mesh::encode(mesh::decode_request(bytes)) == bytes,
                "the helper's request comes back as another");
}

void take(const v1::CreateMeshRequest& request) {
  records::MeshRecord record;
  record.title = request.title();
  record.definition = api::to_definition(request);
  check_record(record, store::decode_mesh_record);
  try {
    if (const auto* source = std::get_if<records::GeometrySource>(&record.definition)) {
      plan(*source);
    } else {
      mesh::check_for_upload(std::get<records::UploadRef>(record.definition).options);
    }
  } catch (const errors::Error& error) {
    throw api::below_mesh_request(error);
  }
}

void take(const v1::CreateJobRequest& request) {
  using namespace std::chrono_literals;
  api::require_request_id(request.request_id());
  records::JobRecord record;
  record.request_id = request.request_id();
  record.spec = api::to_spec(request.spec(), {100'000, 1h, 1h});
  check_record(record, store::decode_job_record);
  try {
    for (const fem::Load& load : record.spec.loads) fem::check(load, max_expression_bytes);
  } catch (const errors::Error& error) {
    throw api::below_job_request(error);
  }
}

template <class Request>
void take_mesh(const Request& request) {
  const std::string id = api::mesh_id(request.name(), "name");
  fuzz::require(api::mesh_name(id) == request.name(), "a mesh has two names");
}

template <class Request>
void take_job(const Request& request) {
  const std::string id = api::job_id(request.name(), "name");
  fuzz::require(api::job_name(id) == request.name(), "a job has two names");
}

template <class Request>
void take_page(const Request& request) {
  const rpc::Page page = rpc::to_page(request.page_size(), request.page_token());
  fuzz::require(page.size > 0 && page.size <= rpc::max_page_size, "a page without bound");
}

/// The last message below this one; null where it has none.
google::protobuf::Message* last_message(google::protobuf::Message& message) {
  const google::protobuf::Reflection& reflection = *message.GetReflection();
  std::vector<const google::protobuf::FieldDescriptor*> fields;
  reflection.ListFields(message, &fields);
  for (auto field = fields.rbegin(); field != fields.rend(); ++field) {
    if ((*field)->cpp_type() != google::protobuf::FieldDescriptor::CPPTYPE_MESSAGE) continue;
    if (!(*field)->is_repeated()) return reflection.MutableMessage(&message, *field);
    return reflection.MutableRepeatedMessage(&message, *field,
                                             reflection.FieldSize(message, *field) - 1);
  }
  return nullptr;
}

/// As a newer client sends it, with a field added at most `depth` messages below the request.
template <class Request>
void refuse_unknown(Request request, int depth) {
  google::protobuf::Message* message = &request;
  for (google::protobuf::Message* below = message; below != nullptr && depth >= 0; --depth) {
    message = below;
    below = last_message(*message);
  }
  message->GetReflection()->MutableUnknownFields(message)->AddVarint(
      google::protobuf::FieldDescriptor::kMaxNumber, 1);
  Request received;
  fuzz::require(received.ParseFromString(request.SerializeAsString()), "it cannot be parsed again");
  try {
    api::require_known(received);
  } catch (const errors::Error& error) {
    fuzz::require(error.reason() == errors::Reason::not_implemented, error.what());
    return;
  }
  fuzz::require(false, "an unknown field is accepted");
}

template <class Request, class Take>
void parsed(const std::string& bytes, int depth, const Take& take) {
  Request request;
  if (!request.ParseFromString(bytes)) return;
  refuse_unknown(request, depth);
  api::require_known(request);
  take(request);
}

void dispatch(int which, int depth, const std::string& bytes) {
  const auto mesh_name = [](const auto& request) { take_mesh(request); };
  const auto job_name = [](const auto& request) { take_job(request); };
  const auto page = [](const auto& request) { take_page(request); };
  const auto whole = [](const auto& request) { take(request); };
  switch (which) {
    case 0:
      return parsed<v1::CreateMeshRequest>(bytes, depth, whole);
    case 1:
      return parsed<v1::CreateJobRequest>(bytes, depth, whole);
    case 2:
      return parsed<v1::GetMeshRequest>(bytes, depth, mesh_name);
    case 3:
      return parsed<v1::ReadMeshRequest>(bytes, depth, mesh_name);
    case 4:
      return parsed<v1::DeleteMeshRequest>(bytes, depth, mesh_name);
    case 5:
      return parsed<v1::WarmMeshRequest>(bytes, depth, mesh_name);
    case 6:
      return parsed<v1::EvictMeshRequest>(bytes, depth, mesh_name);
    case 7:
      return parsed<v1::GetJobRequest>(bytes, depth, job_name);
    case 8:
      return parsed<v1::CancelJobRequest>(bytes, depth, job_name);
    case 9:
      return parsed<v1::DeleteJobRequest>(bytes, depth, job_name);
    case 10:
      return parsed<v1::WatchJobRequest>(bytes, depth, job_name);
    case 11:
      return parsed<v1::ReadResultRequest>(bytes, depth, job_name);
    case 12:
      return parsed<v1::ListMeshesRequest>(bytes, depth, page);
    default:
      return parsed<v1::ListJobsRequest>(bytes, depth, page);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Pieces pieces(fuzz::text_of(data, size));
  const int chosen = pieces.selector();
  try {
    dispatch(chosen % 14, chosen / 14, pieces.rest());
  } catch (const errors::Error& error) {
    fuzz::require(error.reason() != errors::Reason::internal, error.what());
  }
  return 0;
}
