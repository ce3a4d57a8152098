// SPDX-License-Identifier: GPL-3.0-or-later
//
// The gRPC part of a Connection, the retry loop of every call, and the streams of blocks: a layout
// and chunks, resumed by offset. For the sources of this folder only.
#pragma once

#include <grpcpp/grpcpp.h>

#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <type_traits>

#include "anticrack/v1/case.grpc.pb.h"
#include "anticrack/v1/mesh.grpc.pb.h"
#include "anticrack/v1/server.grpc.pb.h"
#include "anticrack/v1/solve.grpc.pb.h"
#include "anticrack/v1/upload.grpc.pb.h"
#include "client/block.hpp"
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
  std::shared_ptr<grpc::Channel> bulk;  ///< channel of bulk reads and uploads
  std::atomic<bool> met = false;        ///< the server has answered once

  /// The mesh that a resource name is about: its own, or that of a job which an answer told; else
  /// empty.
  std::string mesh_of(const std::string& name);
  /// Notes the mesh of a job.
  void learn(const v1::Job& job);

 private:
  std::mutex _mutex;
  std::map<std::string, std::string> _meshes;  ///< of jobs, by their names
};

/// Puts the token of the connection, if any, on a call that is about to start, and the id of the
/// mesh that it is about, if one is known, by which balancers send calls for one mesh to one
/// server.
void prepare(const Connection::State& state, grpc::ClientContext& context,
             const std::string& mesh = {});

/// The mesh that a request is about, "meshes/ID"; empty if that is not known.
template <class Request>
std::string mesh_of(Connection::State& state, const Request& request) {
  if constexpr (requires { request.spec().mesh(); })
    return request.spec().mesh();
  else if constexpr (requires { request.mesh().starts_with(""); })
    return request.mesh();
  else if constexpr (requires { request.name(); })
    return state.mesh_of(request.name());
  else
    return {};
}

/// The error of a call that ended with `status`, which is not OK. If there was no reply of the
/// server (UNAVAILABLE), or credentials were refused, the message has the cure.
Error error_of(const Connection::State& state, const grpc::Status& status);

/// Waits before the next try of a call, or gives up.
class Retries {
 public:
  /// `channel`: that of the call.
  Retries(Connection::State& state, grpc::Channel& channel);

  /// Returns when it is time to try again, after a try that ended with `status`; OK: a stream that
  /// ended too early. Throws its Error to give up, Interrupted on `stop`.
  void wait(const grpc::Status& status, const std::stop_token& stop);
  /// To be called when the server has answered.
  void succeeded();
  /// Whether the connection was lost in one of the tries, so that a response may have been.
  bool lost() const noexcept { return _lost; }

 private:
  Connection::State& _state;
  grpc::Channel& _channel;
  Backoff _backoff;
  std::optional<std::chrono::steady_clock::time_point> _failing_since;
  std::optional<Error> _first_error;  ///< the first error since the last success
  bool _lost = false;
};

/// Sleeps; throws Interrupted on `stop`.
void sleep(std::chrono::milliseconds time, const std::stop_token& stop);

/// The response of a unary method; after a lost connection the call is retried with back-off.
/// Throws Error, and Interrupted once `stop` is requested. `deletes`: NOT_FOUND after a lost
/// response is success.
template <class Stub, class Request, class Response>
Response call(Connection& connection,
              grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
              const Request& request, const std::stop_token& stop, bool deletes = false) {
  Connection::State& state = connection.state();
  Stub stub(state.channel);
  Retries retries(state, *state.channel);
  while (true) {
    grpc::ClientContext context;
    prepare(state, context, mesh_of(state, request));
    context.set_deadline(std::chrono::system_clock::now() + state.options.deadline);
    const std::stop_callback cancel(stop, [&context] { context.TryCancel(); });
    Response response;
    const grpc::Status status = (stub.*method)(&context, request, &response);
    if (status.ok() ||
        (deletes && retries.lost() && status.error_code() == grpc::StatusCode::NOT_FOUND)) {
      retries.succeeded();
      if constexpr (std::is_same_v<Response, v1::Job>) state.learn(response);
      return response;
    }
    retries.wait(status, stop);
  }
}

/// The same for a request that has only a name.
template <class Stub, class Request, class Response>
Response call_named(Connection& connection,
                    grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                    const std::string& name, const std::stop_token& stop, bool deletes = false) {
  Request request;
  request.set_name(name);
  return call(connection, method, request, stop, deletes);
}

/// Passes on the messages of a stream to take(message); returns the status with which it ended. No
/// deadline: jobs may take days, heartbeats show life. `stop` ends the stream; so does what `take`
/// throws.
template <class Stub, class Request, class Response, class Take>
grpc::Status read_stream(Connection::State& state, const std::shared_ptr<grpc::Channel>& channel,
                         std::unique_ptr<grpc::ClientReader<Response>> (Stub::*method)(
                             grpc::ClientContext*, const Request&),
                         const Request& request, const std::stop_token& stop, const Take& take) {
  Stub stub(channel);
  grpc::ClientContext context;
  prepare(state, context, mesh_of(state, request));
  const std::stop_callback cancel(stop, [&context] { context.TryCancel(); });
  const auto reader = (stub.*method)(&context, request);
  Response message;
  try {
    while (reader->Read(&message)) take(message);
  } catch (...) {
    context.TryCancel();
    reader->Finish();
    throw;
  }
  return reader->Finish();
}

/// A damaged chunk is requested again, this often in a row; then the error is thrown.
inline constexpr int tries_of_damaged_data = 3;

/// The block that a method streams, complete and checked. After a lost connection the read goes on
/// where it was. Throws Error, and Interrupted once `stop` is requested.
template <class Stub, class Request, class Response>
Block read_block(Connection& connection,
                 std::unique_ptr<grpc::ClientReader<Response>> (Stub::*method)(grpc::ClientContext*,
                                                                               const Request&),
                 const std::string& name, const std::stop_token& stop) {
  Connection::State& state = connection.state();
  BlockReceiver receiver;
  Retries retries(state, *state.bulk);
  int damaged = 0;
  Request request;
  request.set_name(name);
  while (true) {
    request.set_offset(receiver.offset());
    const auto take = [&](const Response& response) {
      if (response.has_layout()) return receiver.accept(response.layout());
      if (!response.has_chunk()) return;
      receiver.accept(response.chunk());
      if (response.chunk().data().empty()) return;  // this is no progress
      retries.succeeded();
      damaged = 0;
    };
    grpc::Status status;
    try {
      status = read_stream(state, state.bulk, method, request, stop, take);
    } catch (const Error&) {
      if (++damaged == tries_of_damaged_data) throw;
      continue;
    }
    if (receiver.complete()) return receiver.finish();
    retries.wait(status, stop);
  }
}

}  // namespace anticrack::client
