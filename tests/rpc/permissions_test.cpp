// SPDX-License-Identifier: GPL-3.0-or-later
//
// Every method against everybody.
#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <set>

#include "rpc/details.hpp"
#include "rpc/people.hpp"
#include "rpc/requests.hpp"
#include "rpc/running_server.hpp"
#include "support/eventually.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::Context;
using anticrack::testing::eventually;
using anticrack::testing::opening_job;
using anticrack::testing::paper_mesh;
using anticrack::testing::RunningServer;
using anticrack::testing::small_msh;
namespace testing = anticrack::testing;
using Code = grpc::StatusCode;

constexpr Code ok = Code::OK;
constexpr Code who = Code::UNAUTHENTICATED;
constexpr Code not_found = Code::NOT_FOUND;
constexpr Code denied = Code::PERMISSION_DENIED;

/// Ada's things: some that stay, and fresh ones for the methods that take them away.
class Things {
  double _size = 0.2;  ///< each size is another mesh; before what is made with it

 public:
  Things()
      : server([](auto& settings) { settings.server.security.tokens = testing::people(); }),
        mesh(fresh_mesh()),
        job(fresh_job()) {}

  std::string fresh_mesh() {
    _size += 0.01;
    v1::Mesh made;
    must([&](Context& context) {
      return server.meshes->CreateMesh(&context, paper_mesh(_size), &made);
    });
    v1::GetMeshRequest request;
    request.set_name(made.name());
    EXPECT_TRUE(eventually([&] {
      must([&](Context& context) { return server.meshes->GetMesh(&context, request, &made); });
      return made.state() == v1::Mesh::STATE_READY;
    }));
    return made.name();
  }

  std::string fresh_job() {
    v1::Job made;
    must([&](Context& context) {
      return server.jobs->CreateJob(&context, opening_job(mesh), &made);
    });
    v1::GetJobRequest request;
    request.set_name(made.name());
    EXPECT_TRUE(eventually([&] {
      must([&](Context& context) { return server.jobs->GetJob(&context, request, &made); });
      return made.status().state() == v1::JobStatus::STATE_SUCCEEDED;
    }));
    return made.name();
  }

  /// An array of its own for each call.
  std::string fresh_upload() {
    Context context(testing::owner_token);
    v1::CreateUploadsResponse response;
    const auto writer = server.uploads->CreateUploads(&context, &response);
    _size += 0.01;
    const std::string bytes(reinterpret_cast<const char*>(&_size), sizeof _size);
    v1::CreateUploadsRequest part;
    part.mutable_header()->set_size(bytes.size());
    part.mutable_header()->set_sha256(digest::Sha256().add(bytes).finish());
    part.mutable_header()->set_kind(v1::Upload::KIND_ARRAY);
    writer->Write(part);
    part.set_chunk(bytes);
    writer->Write(part);
    writer->WritesDone();
    EXPECT_TRUE(writer->Finish().ok());
    return response.uploads(0).name();
  }

  RunningServer server;
  const std::string mesh;
  const std::string job;

 private:
  void must(const std::function<grpc::Status(Context&)>& call) {
    Context context(testing::owner_token);
    const grpc::Status status = call(context);
    ASSERT_TRUE(status.ok()) << status.error_message();
  }
};

using Call = std::function<grpc::Status(Things&, Context&)>;

template <class Request>
Request named(const std::string& name) {
  Request request;
  request.set_name(name);
  return request;
}

template <class Reader, class Response>
grpc::Status read_all(const std::unique_ptr<Reader>& reader, Response response) {
  while (reader->Read(&response)) {
  }
  return reader->Finish();
}

struct Row {
  std::string method;
  Call call;
  /// No token, a wrong one, another user, the owner, an administrator.
  std::array<Code, 5> expected;
};

grpc::Status upload(Things& things, Context& context) {
  v1::CreateUploadsResponse response;
  const auto writer = things.server.uploads->CreateUploads(&context, &response);
  v1::CreateUploadsRequest part;
  part.mutable_header()->set_size(small_msh().size());
  part.mutable_header()->set_sha256(digest::Sha256().add(small_msh()).finish());
  if (writer->Write(part)) {
    part.set_chunk(small_msh());
    writer->Write(part);
  }
  writer->WritesDone();
  return writer->Finish();
}

Call warm(bool pin) {
  return [pin](Things& things, Context& context) {
    auto request = named<v1::WarmMeshRequest>(things.mesh);
    request.set_pin(pin);
    v1::Mesh mesh;
    return things.server.meshes->WarmMesh(&context, request, &mesh);
  };
}

std::vector<Row> permission_rows() {
  const std::string uploads = "anticrack.v1.UploadService.";
  const std::string meshes = "anticrack.v1.MeshService.";
  const std::string solves = "anticrack.v1.SolveService.";
  return {
      {uploads + "CreateUploads", upload, {who, who, ok, ok, ok}},
      {uploads + "GetUpload",
       [](Things& things, Context& context) {
         v1::Upload answer;
         return things.server.uploads->GetUpload(
             &context, named<v1::GetUploadRequest>(things.fresh_upload()), &answer);
       },
       {who, who, not_found, ok, not_found}},
      {uploads + "ListUploads",
       [](Things& things, Context& context) {
         v1::ListUploadsResponse response;
         return things.server.uploads->ListUploads(&context, {}, &response);
       },
       {who, who, ok, ok, ok}},
      {uploads + "DeleteUpload",
       [](Things& things, Context& context) {
         google::protobuf::Empty nothing;
         return things.server.uploads->DeleteUpload(
             &context, named<v1::DeleteUploadRequest>(things.fresh_upload()), &nothing);
       },
       {who, who, not_found, ok, not_found}},
      {meshes + "CreateMesh",
       [](Things& things, Context& context) {
         v1::Mesh mesh;
         return things.server.meshes->CreateMesh(&context, paper_mesh(0.2), &mesh);
       },
       {who, who, ok, ok, ok}},
      {meshes + "GetMesh",
       [](Things& things, Context& context) {
         v1::Mesh mesh;
         return things.server.meshes->GetMesh(&context, named<v1::GetMeshRequest>(things.mesh),
                                              &mesh);
       },
       {who, who, not_found, ok, ok}},
      {meshes + "ListMeshes",
       [](Things& things, Context& context) {
         v1::ListMeshesResponse response;
         return things.server.meshes->ListMeshes(&context, {}, &response);
       },
       {who, who, ok, ok, ok}},
      {meshes + "ReadMesh",
       [](Things& things, Context& context) {
         const auto request = named<v1::ReadMeshRequest>(things.mesh);
         return read_all(things.server.meshes->ReadMesh(&context, request), v1::ReadMeshResponse());
       },
       {who, who, not_found, ok, ok}},
      {meshes + "DeleteMesh",
       [](Things& things, Context& context) {
         google::protobuf::Empty nothing;
         return things.server.meshes->DeleteMesh(
             &context, named<v1::DeleteMeshRequest>(things.fresh_mesh()), &nothing);
       },
       {who, who, not_found, ok, ok}},
      {meshes + "WarmMesh", warm(false), {who, who, not_found, ok, ok}},
      {meshes + "WarmMesh", warm(true), {who, who, denied, denied, ok}},
      {meshes + "EvictMesh",
       [](Things& things, Context& context) {
         v1::Mesh mesh;
         return things.server.meshes->EvictMesh(&context, named<v1::EvictMeshRequest>(things.mesh),
                                                &mesh);
       },
       {who, who, denied, denied, ok}},
      {solves + "CreateJob",
       [](Things& things, Context& context) {
         v1::Job job;
         return things.server.jobs->CreateJob(&context, opening_job(things.mesh), &job);
       },
       {who, who, not_found, ok, ok}},
      {solves + "GetJob",
       [](Things& things, Context& context) {
         v1::Job job;
         return things.server.jobs->GetJob(&context, named<v1::GetJobRequest>(things.job), &job);
       },
       {who, who, not_found, ok, ok}},
      {solves + "ListJobs",
       [](Things& things, Context& context) {
         v1::ListJobsResponse response;
         return things.server.jobs->ListJobs(&context, {}, &response);
       },
       {who, who, ok, ok, ok}},
      {solves + "CancelJob",
       [](Things& things, Context& context) {
         v1::Job job;
         return things.server.jobs->CancelJob(&context, named<v1::CancelJobRequest>(things.job),
                                              &job);
       },
       {who, who, not_found, ok, ok}},
      {solves + "DeleteJob",
       [](Things& things, Context& context) {
         google::protobuf::Empty nothing;
         return things.server.jobs->DeleteJob(
             &context, named<v1::DeleteJobRequest>(things.fresh_job()), &nothing);
       },
       {who, who, not_found, ok, ok}},
      {solves + "WatchJob",
       [](Things& things, Context& context) {
         const auto request = named<v1::WatchJobRequest>(things.job);
         return read_all(things.server.jobs->WatchJob(&context, request), v1::WatchJobResponse());
       },
       {who, who, not_found, ok, ok}},
      {solves + "ReadResult",
       [](Things& things, Context& context) {
         const auto request = named<v1::ReadResultRequest>(things.job);
         return read_all(things.server.jobs->ReadResult(&context, request),
                         v1::ReadResultResponse());
       },
       {who, who, not_found, ok, ok}},
      {"anticrack.v1.ServerService.GetServerInfo",
       [](Things& things, Context& context) {
         v1::ServerInfo info;
         return things.server.servers->GetServerInfo(&context, {}, &info);
       },
       {who, who, ok, ok, ok}},
  };
}

TEST(Permissions, HoldForEveryMethodAndEverybody) {
  Things things;
  const std::array<std::pair<std::string, std::string>, 5> everybody{
      {{"nobody", ""},
       {"a wrong token", testing::wrong_token},
       {"another user", testing::other_token},
       {"the owner", testing::owner_token},
       {"an administrator", testing::admin_token}}};
  for (const Row& row : permission_rows()) {
    for (std::size_t i = 0; i < everybody.size(); ++i) {
      SCOPED_TRACE(row.method + " by " + everybody[i].first);
      grpc::Status status;
      // What a job or a factorisation that just ended still holds is free in a moment.
      EXPECT_TRUE(eventually([&] {
        Context context(everybody[i].second);
        status = row.call(things, context);
        return status.error_code() != Code::FAILED_PRECONDITION;
      }));
      EXPECT_EQ(status.error_code(), row.expected[i]) << status.error_message();
      if (status.ok()) continue;
      testing::details_of(status);  // in the form error.proto promises
      EXPECT_EQ(status.error_message().find("token-of"), std::string::npos);
    }
  }
}

TEST(Permissions, HaveARowForEveryMethodThereIs) {
  std::set<std::string> known;
  for (const Row& row : permission_rows()) known.insert(row.method);
  std::set<std::string> methods;
  for (const auto* file : {v1::Upload::descriptor()->file(), v1::Mesh::descriptor()->file(),
                           v1::Job::descriptor()->file(), v1::ServerInfo::descriptor()->file()}) {
    for (int i = 0; i < file->service_count(); ++i) {
      const google::protobuf::ServiceDescriptor& service = *file->service(i);
      for (int k = 0; k < service.method_count(); ++k) {
        methods.insert(service.method(k)->full_name());
      }
    }
  }
  EXPECT_EQ(known, methods);
}

}  // namespace
}  // namespace anticrack::rpc
