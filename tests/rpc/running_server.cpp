// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/running_server.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <thread>
#include <utility>

#include "operators/mesh_operator.hpp"
#include "rpc/requests.hpp"

namespace anticrack::testing {
Context::Context() { set_deadline(std::chrono::system_clock::now() + std::chrono::minutes(2)); }

Context::Context(const std::string& token) : Context() {
  if (!token.empty()) AddMetadata("authorization", "Bearer " + token);
}

RunningServer::RunningServer(const std::function<void(Settings&)>& adjust) {
  _settings.engine.max_iterations = 2'000'000'000;
  _settings.catalogue.helper.executable = ANTICRACK_MESHER;
  _settings.server.listen = "127.0.0.1:0";
  if (adjust) adjust(_settings);
  operators::require_threadsafe_blas();
  start();
}

RunningServer::~RunningServer() { stop(); }

void RunningServer::restart() {
  stop();
  start();
}

void RunningServer::start() {
  _store = store::open({_folder.path()});
  _cache = std::make_unique<operators::OperatorCache>(
      std::uint64_t{1} << 30, [](std::shared_ptr<const mesh::Mesh> mesh, std::stop_token stop) {
        return operators::MeshOperator::factorise(std::move(mesh), 2, std::move(stop));
      });
  _catalogue = std::make_unique<meshes::MeshCatalogue>(_settings.catalogue, *_store, *_cache);
  _engine = std::make_unique<jobs::JobEngine>(_settings.engine, *_store, *_catalogue);
  _server = std::make_unique<rpc::Server>(_settings.server,
                                          rpc::Backend{*_engine, *_catalogue, *_cache, *_store});
  const auto shared = channel();
  uploads = v1::UploadService::NewStub(shared);
  meshes = v1::MeshService::NewStub(shared);
  jobs = v1::SolveService::NewStub(shared);
  servers = v1::ServerService::NewStub(shared);
}

void RunningServer::stop() {
  _server.reset();
  _engine.reset();
  _catalogue.reset();
  _cache.reset();
  _store.reset();
}

std::size_t RunningServer::upload_files() const {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(_folder / "uploads")) {
    if (entry.is_regular_file()) ++count;
  }
  return count;
}

std::shared_ptr<grpc::Channel> RunningServer::channel(
    const std::shared_ptr<grpc::ChannelCredentials>& credentials) const {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  return grpc::CreateCustomChannel(_server->address(), credentials, arguments);
}

v1::Mesh RunningServer::create(const v1::CreateMeshRequest& request) {
  return must(*meshes, &Meshes::CreateMesh, request);
}

v1::Job RunningServer::create(const v1::CreateJobRequest& request) {
  return must(*jobs, &Jobs::CreateJob, request);
}

v1::ServerInfo RunningServer::info() { return must(*servers, &Servers::GetServerInfo, {}); }

v1::Job RunningServer::job(const std::string& name) {
  return must(*jobs, &Jobs::GetJob, named<v1::GetJobRequest>(name));
}

v1::Mesh RunningServer::mesh(const std::string& name) {
  return must(*meshes, &Meshes::GetMesh, named<v1::GetMeshRequest>(name));
}

grpc::Status RunningServer::try_create(const v1::CreateMeshRequest& request) {
  return call(*meshes, &Meshes::CreateMesh, request);
}

grpc::Status RunningServer::try_create(const v1::CreateJobRequest& request) {
  return call(*jobs, &Jobs::CreateJob, request);
}

grpc::Status RunningServer::cancel(const std::string& job) {
  return call(*jobs, &Jobs::CancelJob, named<v1::CancelJobRequest>(job));
}

grpc::Status RunningServer::upload(const v1::CreateUploadsRequest::Header& header,
                                   const std::string& content, std::string* name, std::size_t chunk,
                                   const std::string& token) {
  BegunUpload begun(*this, header, token);
  bool open = true;
  for (std::size_t offset = 0; open && offset < content.size(); offset += chunk)
    open = begun.send(content.substr(offset, chunk));
  const grpc::Status status = begun.finish();
  if (name != nullptr && status.ok()) *name = begun.name();
  return status;
}

grpc::Status RunningServer::upload(const std::string& content, std::string* name) {
  return upload(upload_header(content), content, name);
}

grpc::Status RunningServer::watch(const std::string& job, std::uint64_t after,
                                  std::vector<v1::WatchJobResponse>& events) {
  Context context;
  auto request = named<v1::WatchJobRequest>(job);
  request.set_after_sequence(after);
  const auto reader = jobs->WatchJob(&context, request);
  v1::WatchJobResponse event;
  while (reader->Read(&event)) events.push_back(event);
  return reader->Finish();
}

v1::Job RunningServer::finish(const std::string& name) {
  std::vector<v1::WatchJobResponse> events;
  const grpc::Status status = watch(name, 0, events);
  EXPECT_TRUE(status.ok()) << status.error_message();
  return job(name);
}

v1::Mesh RunningServer::settle(const std::string& name) {
  for (;;) {
    const v1::Mesh current = mesh(name);
    if (current.state() == v1::Mesh::STATE_READY || current.state() == v1::Mesh::STATE_FAILED ||
        current.name().empty()) {
      return current;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

BegunUpload::BegunUpload(RunningServer& server, const v1::CreateUploadsRequest::Header& header,
                         const std::string& token)
    : _context(token), _writer(server.uploads->CreateUploads(&_context, &_response)) {
  v1::CreateUploadsRequest part;
  *part.mutable_header() = header;
  _writer->Write(part);
}

bool BegunUpload::send(const std::string& chunk) {
  v1::CreateUploadsRequest part;
  part.set_chunk(chunk);
  return _writer->Write(part);
}

grpc::Status BegunUpload::finish() {
  _writer->WritesDone();
  return _writer->Finish();
}

grpc::Status BegunUpload::drop() {
  _context.TryCancel();
  return _writer->Finish();
}

}  // namespace anticrack::testing
