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

using anticrack::testing::call;
using anticrack::testing::Context;
using anticrack::testing::eventually;
using anticrack::testing::Jobs;
using anticrack::testing::Meshes;
using anticrack::testing::must;
using anticrack::testing::named;
using anticrack::testing::opening_job;
using anticrack::testing::paper_mesh;
using anticrack::testing::RunningServer;
using anticrack::testing::Servers;
using anticrack::testing::small_msh;
using anticrack::testing::Uploads;
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
    const std::string name =
        must(*server.meshes, &Meshes::CreateMesh, paper_mesh(_size), testing::owner_token).name();
    const auto request = named<v1::GetMeshRequest>(name);
    EXPECT_TRUE(eventually([&] {
      return must(*server.meshes, &Meshes::GetMesh, request, testing::owner_token).state() ==
             v1::Mesh::STATE_READY;
    }));
    return name;
  }

  std::string fresh_job() {
    const std::string name =
        must(*server.jobs, &Jobs::CreateJob, opening_job(mesh), testing::owner_token).name();
    const auto request = named<v1::GetJobRequest>(name);
    EXPECT_TRUE(eventually([&] {
      return must(*server.jobs, &Jobs::GetJob, request, testing::owner_token).status().state() ==
             v1::JobStatus::STATE_SUCCEEDED;
    }));
    return name;
  }

  /// An array of its own for each call.
  std::string fresh_upload() {
    _size += 0.01;
    const std::string bytes = testing::packed({_size});
    std::string name;
    EXPECT_TRUE(server
                    .upload(testing::upload_header(bytes, v1::Upload::KIND_ARRAY), bytes, &name,
                            bytes.size(), testing::owner_token)
                    .ok());
    return name;
  }

  RunningServer server;
  const std::string mesh;
  const std::string job;
};

using Call = std::function<grpc::Status(Things&, const std::string& token)>;

/// Calls a method with the request that make(things) gives.
template <class Stub, class Request, class Response>
Call on(
    std::unique_ptr<Stub> RunningServer::*stub,
    grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
    const std::function<std::type_identity_t<Request>(Things&)>& make = [](Things&) {
      return Request();
    }) {
  return [=](Things& things, const std::string& token) {
    return call(*(things.server.*stub), method, make(things), nullptr, token);
  };
}
/// The same for a request about what has name(things).
template <class Stub, class Request, class Response>
Call of(std::unique_ptr<Stub> RunningServer::*stub,
        grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
        const std::function<std::string(Things&)>& name) {
  return on(stub, method, [=](Things& things) { return named<Request>(name(things)); });
}

/// Reads a stream about what has name(things) to its end.
template <class Stub, class Request, class Response>
Call read(std::unique_ptr<Stub> RunningServer::*stub,
          std::unique_ptr<grpc::ClientReader<Response>> (Stub::*method)(grpc::ClientContext*,
                                                                        const Request&),
          const std::string Things::*name) {
  return [=](Things& things, const std::string& token) {
    Context context(token);
    const auto reader = ((*(things.server.*stub)).*method)(&context, named<Request>(things.*name));
    Response response;
    while (reader->Read(&response)) {
    }
    return reader->Finish();
  };
}

struct Row {
  std::string method;
  Call call;
  /// No token, a wrong one, another user, the owner, an administrator.
  std::array<Code, 5> expected;
};

grpc::Status upload(Things& things, const std::string& token) {
  return things.server.upload(testing::upload_header(small_msh()), small_msh(), nullptr, 1000,
                              token);
}

Call warm(bool pin) {
  return on(&RunningServer::meshes, &Meshes::WarmMesh, [pin](Things& things) {
    auto request = named<v1::WarmMeshRequest>(things.mesh);
    request.set_pin(pin);
    return request;
  });
}

std::vector<Row> permission_rows() {
  const std::string uploads = "anticrack.v1.UploadService.", meshes = "anticrack.v1.MeshService.",
                    solves = "anticrack.v1.SolveService.";
  constexpr auto to_uploads = &RunningServer::uploads;
  constexpr auto to_meshes = &RunningServer::meshes;
  constexpr auto to_jobs = &RunningServer::jobs;
  return {
      {uploads + "CreateUploads", upload, {who, who, ok, ok, ok}},
      {uploads + "GetUpload",
       of(to_uploads, &Uploads::GetUpload, &Things::fresh_upload),
       {who, who, not_found, ok, not_found}},
      {uploads + "ListUploads", on(to_uploads, &Uploads::ListUploads), {who, who, ok, ok, ok}},
      {uploads + "DeleteUpload",
       of(to_uploads, &Uploads::DeleteUpload, &Things::fresh_upload),
       {who, who, not_found, ok, not_found}},
      {meshes + "CreateMesh",
       on(to_meshes, &Meshes::CreateMesh, [](Things&) { return paper_mesh(0.2); }),
       {who, who, ok, ok, ok}},
      {meshes + "GetMesh",
       of(to_meshes, &Meshes::GetMesh, &Things::mesh),
       {who, who, not_found, ok, ok}},
      {meshes + "ListMeshes", on(to_meshes, &Meshes::ListMeshes), {who, who, ok, ok, ok}},
      {meshes + "ReadMesh",
       read(to_meshes, &Meshes::ReadMesh, &Things::mesh),
       {who, who, not_found, ok, ok}},
      {meshes + "DeleteMesh",
       of(to_meshes, &Meshes::DeleteMesh, &Things::fresh_mesh),
       {who, who, not_found, ok, ok}},
      {meshes + "WarmMesh", warm(false), {who, who, not_found, ok, ok}},
      {meshes + "WarmMesh", warm(true), {who, who, denied, denied, ok}},
      {meshes + "EvictMesh",
       of(to_meshes, &Meshes::EvictMesh, &Things::mesh),
       {who, who, denied, denied, ok}},
      {solves + "CreateJob",
       on(to_jobs, &Jobs::CreateJob, [](Things& things) { return opening_job(things.mesh); }),
       {who, who, not_found, ok, ok}},
      {solves + "GetJob", of(to_jobs, &Jobs::GetJob, &Things::job), {who, who, not_found, ok, ok}},
      {solves + "ListJobs", on(to_jobs, &Jobs::ListJobs), {who, who, ok, ok, ok}},
      {solves + "CancelJob",
       of(to_jobs, &Jobs::CancelJob, &Things::job),
       {who, who, not_found, ok, ok}},
      {solves + "DeleteJob",
       of(to_jobs, &Jobs::DeleteJob, &Things::fresh_job),
       {who, who, not_found, ok, ok}},
      {solves + "WatchJob",
       read(to_jobs, &Jobs::WatchJob, &Things::job),
       {who, who, not_found, ok, ok}},
      {solves + "ReadResult",
       read(to_jobs, &Jobs::ReadResult, &Things::job),
       {who, who, not_found, ok, ok}},
      {"anticrack.v1.ServerService.GetServerInfo",
       on(&RunningServer::servers, &Servers::GetServerInfo),
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
        status = row.call(things, everybody[i].second);
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
