// SPDX-License-Identifier: GPL-3.0-or-later
//
// The real server with everything below it, in this process, and stubs on a channel to it.
#pragma once

#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "anticrack/v1/mesh.grpc.pb.h"
#include "anticrack/v1/server.grpc.pb.h"
#include "anticrack/v1/solve.grpc.pb.h"
#include "anticrack/v1/upload.grpc.pb.h"
#include "jobs/job_engine.hpp"
#include "meshes/mesh_catalogue.hpp"
#include "operators/operator_cache.hpp"
#include "rpc/server.hpp"
#include "store/store.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::testing {

/// A context that ends a call that hangs, so that a test fails instead of standing still.
struct Context : grpc::ClientContext {
  Context();
  /// With "authorization: Bearer TOKEN" where the token is not empty.
  explicit Context(const std::string& token);
};

using Uploads = v1::UploadService::Stub;
using Meshes = v1::MeshService::Stub;
using Jobs = v1::SolveService::Stub;
using Servers = v1::ServerService::Stub;

/// A request about what has this name.
template <class Request>
Request named(const std::string& name) {
  Request request;
  request.set_name(name);
  return request;
}

/// Calls a method that takes and gives one message: call(*server.jobs, &Jobs::GetJob, request).
template <class Stub, class Request, class Response>
grpc::Status call(Stub& stub,
                  grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                  const std::type_identity_t<Request>& request,
                  std::type_identity_t<Response>* answer = nullptr, const std::string& token = {}) {
  Context context(token);
  Response unread;
  return (stub.*method)(&context, request, answer != nullptr ? answer : &unread);
}

/// The answer to a call that must succeed.
template <class Stub, class Request, class Response>
Response must(Stub& stub,
              grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
              const std::type_identity_t<Request>& request, const std::string& token = {}) {
  Response answer;
  const grpc::Status status = call(stub, method, request, &answer, token);
  EXPECT_TRUE(status.ok()) << status.error_message();
  return answer;
}

struct Settings {
  meshes::CatalogueOptions catalogue;
  jobs::EngineOptions engine;
  rpc::ServerOptions server;
  std::shared_ptr<grpc::ChannelCredentials> credentials = grpc::InsecureChannelCredentials();
};

class RunningServer {
 public:
  /// On a free port of 127.0.0.1; `adjust` may change the settings.
  explicit RunningServer(const std::function<void(Settings&)>& adjust = {});
  ~RunningServer();
  RunningServer(const RunningServer&) = delete;
  RunningServer& operator=(const RunningServer&) = delete;

  /// All of it ends and starts again on the same folder, on another port.
  void restart();

  rpc::Server& server() { return *_server; }
  rpc::Backend backend() { return {*_engine, *_catalogue, *_cache, *_store}; }
  jobs::JobEngine& engine() { return *_engine; }
  /// Files of uploads, finished or not.
  std::size_t upload_files() const;
  /// A channel of its own.
  std::shared_ptr<grpc::Channel> channel() const { return channel(_settings.credentials); }
  std::shared_ptr<grpc::Channel> channel(
      const std::shared_ptr<grpc::ChannelCredentials>& credentials) const;

  /// Calls that must succeed; gtest failures otherwise.
  v1::Mesh create(const v1::CreateMeshRequest& request);
  v1::Job create(const v1::CreateJobRequest& request);
  v1::ServerInfo info();
  v1::Job job(const std::string& name);
  v1::Mesh mesh(const std::string& name);

  /// The statuses of calls that may fail.
  grpc::Status try_create(const v1::CreateMeshRequest& request);
  grpc::Status try_create(const v1::CreateJobRequest& request);
  grpc::Status cancel(const std::string& job);
  /// Uploads `content` in chunks of `chunk` bytes under the header given.
  grpc::Status upload(const v1::CreateUploadsRequest::Header& header, const std::string& content,
                      std::string* name = nullptr, std::size_t chunk = 1000,
                      const std::string& token = {});
  /// With the right header.
  grpc::Status upload(const std::string& content, std::string* name = nullptr);

  /// Watches to the end of the stream.
  grpc::Status watch(const std::string& job, std::uint64_t after,
                     std::vector<v1::WatchJobResponse>& events);
  /// Waits for the end of the job by watching it.
  v1::Job finish(const std::string& job);
  /// Waits until the mesh is READY or FAILED.
  v1::Mesh settle(const std::string& mesh);

  std::unique_ptr<Uploads> uploads;
  std::unique_ptr<Meshes> meshes;
  std::unique_ptr<Jobs> jobs;
  std::unique_ptr<Servers> servers;

 private:
  void start();
  void stop();

  Settings _settings;
  TemporaryFolder _folder;
  std::unique_ptr<store::Store> _store;
  std::unique_ptr<operators::OperatorCache> _cache;
  std::unique_ptr<meshes::MeshCatalogue> _catalogue;
  std::unique_ptr<jobs::JobEngine> _engine;
  std::unique_ptr<rpc::Server> _server;
};

/// An upload of one file that is begun.
class BegunUpload {
 public:
  BegunUpload(RunningServer& server, const v1::CreateUploadsRequest::Header& header,
              const std::string& token = {});
  bool send(const std::string& chunk);
  grpc::Status finish();
  grpc::Status drop();
  const std::string& name() const { return _response.uploads(0).name(); }

 private:
  Context _context;
  v1::CreateUploadsResponse _response;
  std::unique_ptr<grpc::ClientWriter<v1::CreateUploadsRequest>> _writer;
};

}  // namespace anticrack::testing
