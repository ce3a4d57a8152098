// SPDX-License-Identifier: GPL-3.0-or-later
//
// The gRPC part of a Connection, and the retry loop of every call. For this folder only.
#pragma once

#include <grpcpp/grpcpp.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "anticrack/v1/case.grpc.pb.h"
#include "anticrack/v1/mesh.grpc.pb.h"
#include "anticrack/v1/server.grpc.pb.h"
#include "anticrack/v1/solve.grpc.pb.h"
#include "anticrack/v1/upload.grpc.pb.h"
#include "client/connection.hpp"
#include "client/error.hpp"
#include "client/proxy.hpp"

namespace anticrack::client {

struct Connection::State {
  /// Creates the channels without connecting.
  explicit State(ConnectionOptions chosen);

  ConnectionOptions options;
  std::optional<Proxy> proxy;  ///< the proxy between here and the server
  std::shared_ptr<grpc::Channel> channel;
  std::shared_ptr<grpc::Channel> bulk;  ///< channel of bulk reads
  std::unique_ptr<v1::CaseService::Stub> cases;
  std::unique_ptr<v1::UploadService::Stub> uploads;
  std::unique_ptr<v1::MeshService::Stub> meshes;
  std::unique_ptr<v1::SolveService::Stub> jobs;
  std::unique_ptr<v1::ServerService::Stub> server;
  std::unique_ptr<v1::UploadService::Stub> bulk_uploads;
  std::unique_ptr<v1::MeshService::Stub> bulk_meshes;  ///< on the channel of bulk reads
  std::unique_ptr<v1::SolveService::Stub> bulk_jobs;
  std::atomic<bool> met = false;  ///< the server has answered once
};

/// Puts the token of the connection, if any, on a call that is about to start.
void authorise(const Connection::State& state, grpc::ClientContext& context);

/// The error of a call that ended with `status`, which is not OK. If there was no reply of the
/// server (UNAVAILABLE), or credentials were refused, the message has the cure.
Error error_of(const Connection::State& state, const grpc::Status& status);

/// Waits before the next try of a call, or gives up.
class Retries {
 public:
  /// `channel`: that of the call.
  Retries(Connection::State& state, grpc::Channel& channel);

  /// Returns when it is time to try again. Throws `error` to give up, Interrupted on `stop`.
  void wait(const Error& error, const std::stop_token& stop);
  /// To be called when the server has answered.
  void succeeded();

 private:
  Connection::State& _state;
  grpc::Channel& _channel;
  Backoff _backoff;
  std::optional<std::chrono::steady_clock::time_point> _failing_since;
  std::optional<Error> _first_error;  ///< the first error since the last success
};

/// Sleeps; throws Interrupted on `stop`.
void sleep(std::chrono::milliseconds time, const std::stop_token& stop);

/// Tries a unary call once; `stop` ends it.
template <class Stub, class Request, class Response>
grpc::Status try_call(const Connection::State& state, Stub& stub,
                      grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                      const Request& request, Response& response, const std::stop_token& stop) {
  grpc::ClientContext context;
  authorise(state, context);
  context.set_deadline(std::chrono::system_clock::now() + state.options.deadline);
  const std::stop_callback cancel(stop, [&context] { context.TryCancel(); });
  return (stub.*method)(&context, request, &response);
}

/// The response of a unary method; after a lost connection the call is retried with back-off.
/// Throws Error, and Interrupted once `stop` is requested. `deletes`: NOT_FOUND after a lost
/// response is success.
template <class Stub, class Request, class Response>
Response call(Connection::State& state, Stub& stub,
              grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
              const Request& request, const std::stop_token& stop, bool deletes = false) {
  Retries retries(state, *state.channel);
  bool lost = false;
  while (true) {
    Response response;
    const grpc::Status status = try_call(state, stub, method, request, response, stop);
    if (status.ok() || (deletes && lost && status.error_code() == grpc::StatusCode::NOT_FOUND)) {
      retries.succeeded();
      return response;
    }
    const Error error = error_of(state, status);
    lost = lost || is_lost_connection(error);
    retries.wait(error, stop);
  }
}

/// A request that has only a name.
template <class Request>
Request named(const std::string& name) {
  Request request;
  request.set_name(name);
  return request;
}

}  // namespace anticrack::client
