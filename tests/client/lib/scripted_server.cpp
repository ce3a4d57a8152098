// SPDX-License-Identifier: GPL-3.0-or-later
#include "client/lib/scripted_server.hpp"

#include <grpcpp/grpcpp.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "anticrack/v1/error.pb.h"
#include "anticrack/v1/solve.grpc.pb.h"
#include "anticrack/v1/upload.grpc.pb.h"

namespace anticrack::client {
namespace {

grpc::Status status_of(const Ending& ending) {
  if (ending.code == Code::ok) {
    return grpc::Status::OK;
  }
  const auto code = static_cast<grpc::StatusCode>(ending.code);
  if (ending.retry_delay.count() == 0) {
    return {code, ending.message};
  }
  v1::RetryInfo retry;
  const auto milliseconds = static_cast<std::int64_t>(ending.retry_delay.count());
  retry.mutable_retry_delay()->set_seconds(milliseconds / 1000);
  retry.mutable_retry_delay()->set_nanos(
      static_cast<std::int32_t>(milliseconds % 1000 * 1'000'000));
  v1::Status details;
  details.add_details()->set_type_url("type.googleapis.com/google.rpc.RetryInfo");
  details.mutable_details(0)->set_value(retry.SerializeAsString());
  return {code, ending.message, details.SerializeAsString()};
}

template <class Script>
const Script& script_of_call(const std::vector<Script>& scripts, std::size_t call) {
  return scripts.at(std::min(call, scripts.size() - 1));
}

/// Requests, recorded by gRPC's threads and read by the test's.
template <class Request>
class Record {
 public:
  /// Index of this call.
  std::size_t add(const Request& request) {
    const std::lock_guard lock(_mutex);
    _requests.push_back(request);
    return _requests.size() - 1;
  }
  std::vector<Request> all() const {
    const std::lock_guard lock(_mutex);
    return _requests;
  }

 private:
  mutable std::mutex _mutex;
  std::vector<Request> _requests;
};

class Jobs : public v1::SolveService::Service {
 public:
  explicit Jobs(ScriptedServer& script) : _script(script) {}

  grpc::Status CreateJob(grpc::ServerContext* context, const v1::CreateJobRequest* request,
                         v1::Job* job) override {
    note(*context);
    const std::size_t call = created.add(*request);
    *job->mutable_spec() = request->spec();
    job->set_name("jobs/1");
    return status_of(script_of_call(_script.creations, call));
  }

  grpc::Status WatchJob(grpc::ServerContext* context, const v1::WatchJobRequest* request,
                        grpc::ServerWriter<v1::WatchJobResponse>* writer) override {
    note(*context);
    const WatchScript& script = script_of_call(_script.watches, watched.add(*request));
    for (const v1::WatchJobResponse& message : script.messages) {
      writer->Write(message);
    }
    while (script.hang && !context->IsCancelled()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return status_of(script.ending);
  }

  grpc::Status DeleteJob(grpc::ServerContext* context, const v1::DeleteJobRequest* request,
                         google::protobuf::Empty*) override {
    note(*context);
    return status_of(script_of_call(_script.deletions, deleted.add(*request)));
  }

  grpc::Status ReadResult(grpc::ServerContext* context, const v1::ReadResultRequest* request,
                          grpc::ServerWriter<v1::ReadResultResponse>* writer) override {
    note(*context);
    const ReadScript& script = script_of_call(_script.reads, read.add(*request));
    for (const v1::ReadResultResponse& message : script.messages) {
      writer->Write(message);
    }
    return status_of(script.ending);
  }

  Record<v1::CreateJobRequest> created;
  Record<v1::WatchJobRequest> watched;
  Record<v1::ReadResultRequest> read;
  Record<v1::DeleteJobRequest> deleted;
  Record<std::string> authorizations;

 private:
  void note(const grpc::ServerContext& context) {
    const auto found = context.client_metadata().find("authorization");
    authorizations.add(found == context.client_metadata().end()
                           ? std::string()
                           : std::string(found->second.data(), found->second.size()));
  }

  ScriptedServer& _script;
};

std::shared_ptr<grpc::ServerCredentials> credentials_of(const ServerTls& tls) {
  if (tls.certificate.empty()) {
    return grpc::InsecureServerCredentials();
  }
  grpc::SslServerCredentialsOptions options(
      tls.client_roots.empty() ? GRPC_SSL_DONT_REQUEST_CLIENT_CERTIFICATE
                               : GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY);
  options.pem_root_certs = tls.client_roots;
  options.pem_key_cert_pairs = {{tls.key, tls.certificate}};
  return grpc::SslServerCredentials(options);
}

class Uploads : public v1::UploadService::Service {
 public:
  grpc::Status CreateUploads(grpc::ServerContext*,
                             grpc::ServerReader<v1::CreateUploadsRequest>* reader,
                             v1::CreateUploadsResponse* response) override {
    v1::CreateUploadsRequest request;
    while (reader->Read(&request)) {
      requests.add(request);
      if (request.has_header()) {
        response->add_uploads()->set_name("uploads/" + request.header().sha256());
      }
    }
    return grpc::Status::OK;
  }

  grpc::Status GetUpload(grpc::ServerContext*, const v1::GetUploadRequest* request,
                         v1::Upload* response) override {
    if (deleted) return {grpc::StatusCode::NOT_FOUND, "there is no " + request->name()};
    response->set_name(request->name());
    response->set_size(requests.all().at(0).header().size());
    return grpc::Status::OK;
  }

  grpc::Status ListUploads(grpc::ServerContext*, const v1::ListUploadsRequest*,
                           v1::ListUploadsResponse* response) override {
    for (const v1::CreateUploadsRequest& request : requests.all())
      if (request.has_header())
        response->add_uploads()->set_name("uploads/" + request.header().sha256());
    return grpc::Status::OK;
  }

  grpc::Status DeleteUpload(grpc::ServerContext*, const v1::DeleteUploadRequest*,
                            google::protobuf::Empty*) override {
    deleted = true;
    return grpc::Status::OK;
  }

  std::atomic<bool> deleted = false;
  Record<v1::CreateUploadsRequest> requests;
};

}  // namespace

struct ScriptedServer::Services {
  explicit Services(ScriptedServer& script) : jobs(script) {}

  Jobs jobs;
  Uploads uploads;
  std::unique_ptr<grpc::Server> server;
  int port = 0;
};

ScriptedServer::ScriptedServer(const ServerTls& tls)
    : _services(std::make_unique<Services>(*this)) {
  grpc::ServerBuilder builder;
  builder.AddListeningPort("127.0.0.1:0", credentials_of(tls), &_services->port);
  builder.RegisterService(&_services->jobs);
  builder.RegisterService(&_services->uploads);
  _services->server = builder.BuildAndStart();
  if (!_services->server || _services->port == 0) {
    throw std::runtime_error("the scripted server does not start");
  }
}

ScriptedServer::~ScriptedServer() {
  _services->server->Shutdown(std::chrono::system_clock::now() + std::chrono::seconds(1));
}

std::vector<v1::WatchJobRequest> ScriptedServer::watched() const {
  return _services->jobs.watched.all();
}

std::vector<v1::ReadResultRequest> ScriptedServer::read() const {
  return _services->jobs.read.all();
}

std::vector<v1::CreateJobRequest> ScriptedServer::created() const {
  return _services->jobs.created.all();
}

std::vector<std::string> ScriptedServer::authorizations() const {
  return _services->jobs.authorizations.all();
}

std::string ScriptedServer::uploaded() const {
  std::string bytes;
  for (const v1::CreateUploadsRequest& request : _services->uploads.requests.all()) {
    bytes += request.chunk();
  }
  return bytes;
}

v1::CreateUploadsRequest::Header ScriptedServer::upload_header() const {
  return _services->uploads.requests.all().at(0).header();
}

std::size_t ScriptedServer::largest_upload_chunk() const {
  std::size_t largest = 0;
  for (const v1::CreateUploadsRequest& request : _services->uploads.requests.all()) {
    largest = std::max(largest, request.chunk().size());
  }
  return largest;
}

ConnectionOptions ScriptedServer::options() const {
  ConnectionOptions options;
  options.address = "127.0.0.1:" + std::to_string(_services->port);
  options.retry.first = std::chrono::milliseconds(1);
  options.retry.longest = std::chrono::milliseconds(5);
  return options;
}

v1::WatchJobResponse sample_event(std::uint64_t sequence) {
  v1::WatchJobResponse event;
  event.set_sequence(sequence);
  v1::Samples& samples = *event.mutable_samples();
  samples.add_load_case(0);
  samples.add_iteration(static_cast<std::int32_t>(sequence));
  samples.add_criterion(0.5);
  samples.add_contact_count(1);
  return event;
}

v1::WatchJobResponse snapshot_event(std::uint64_t delivered) {
  v1::WatchJobResponse event;
  event.set_sequence(delivered);
  event.mutable_snapshot()->mutable_job()->set_name("jobs/1");
  return event;
}

v1::WatchJobResponse ended_event(std::uint64_t sequence) {
  v1::WatchJobResponse event;
  event.set_sequence(sequence);
  event.mutable_ended()->set_name("jobs/1");
  event.mutable_ended()->mutable_status()->set_state(v1::JobStatus::STATE_SUCCEEDED);
  return event;
}

}  // namespace anticrack::client
