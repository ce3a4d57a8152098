// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/server.hpp"

#include <grpc/grpc.h>
#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/grpcpp.h>
#include <grpcpp/health_check_service_interface.h>

#include <array>
#include <mutex>
#include <optional>

#include "errors/errors.hpp"
#include "jobs/job_engine.hpp"
#include "rpc/acceptor.hpp"
#include "rpc/call_meter.hpp"
#include "rpc/case_service.hpp"
#include "rpc/edge.hpp"
#include "rpc/mesh_service.hpp"
#include "rpc/server_service.hpp"
#include "rpc/solve_service.hpp"
#include "rpc/tls.hpp"
#include "rpc/upload_service.hpp"

namespace anticrack::rpc {
namespace {

using namespace std::chrono_literals;
using External = grpc::experimental::ExternalConnectionAcceptor;

constexpr std::array service_names{"anticrack.v1.CaseService", "anticrack.v1.UploadService",
                                   "anticrack.v1.MeshService", "anticrack.v1.SolveService",
                                   "anticrack.v1.ServerService"};

/// Bytes that may be in flight from a client on one stream: a chunk, which gives 20 MB/s at 50 ms.
constexpr int receive_window_bytes = 1 << 20;
/// Our streams that have not taken their end by then are broken off.
constexpr auto stream_patience = 2s;
/// Health and reflection streams are not ours and make Shutdown wait until its deadline.
constexpr auto shutdown_patience = 300ms;

/// gRPC shuts down with its last server and then joins the thread that gRPC 1.51 starts when a peer
/// does not take a write at once (run_poller in its tcp_posix.cc). That thread may sleep for ten
/// seconds on sockets that are closed by then. So gRPC stays up until the process ends.
void keep_grpc_up() { grpc_init(); }

void set_arguments(grpc::ServerBuilder& builder) {
  // A connection that does not begin like HTTP/2 or TLS is closed sooner than after gRPC's two
  // minutes.
  builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, 20'000);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, 30'000);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 10'000);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
  // A client's keepalive of 1 s would otherwise end its idle watch with "too many pings".
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS, 500);
  // gRPC 1.51's probe of the connection now and then leaves a client's large messages without
  // window until its own next ping: 13 of 339 uploads of 5 MB stood still for 10 s, none of 800
  // without it.
  builder.AddChannelArgument(GRPC_ARG_HTTP2_BDP_PROBE, 0);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_STREAM_LOOKAHEAD_BYTES, receive_window_bytes);
  builder.SetMaxReceiveMessageSize(max_message_bytes);
}

}  // namespace

void Admission::require_open() const {
  if (_closed) throw draining_error();
}

struct Server::State {
  State(const ServerOptions& options, const Backend& backend)
      : acceptor(options.listen,
                 {options.limits.connections, options.limits.connections_an_address}),
        edge(options, backend),
        cases(edge),
        uploads(edge),
        meshes(edge),
        solves(edge),
        info(edge, options.security) {
    if (options.security.tls) certificates.emplace(*options.security.tls);
  }

  std::shared_ptr<grpc::ServerCredentials> credentials() {
    return certificates ? certificates->credentials() : grpc::InsecureServerCredentials();
  }

  void set_serving(bool serving) {
    grpc::HealthCheckServiceInterface* health = server->GetHealthCheckService();
    health->SetServingStatus(serving);
    for (const char* name : service_names) health->SetServingStatus(name, serving);
  }

  /// We listen ourselves, as gRPC 1.51 stops listening after a moment without descriptors.
  Acceptor acceptor;
  Edge edge;
  CaseService cases;
  UploadService uploads;
  MeshService meshes;
  SolveService solves;
  ServerService info;
  std::optional<Certificates> certificates;
  std::unique_ptr<grpc::Server> server;
  std::once_flag drained;
};

Server::Server(const ServerOptions& options, const Backend& backend)
    : _state(std::make_unique<State>(options, backend)) {
  keep_grpc_up();
  grpc::EnableDefaultHealthCheckService(true);
  grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  grpc::ServerBuilder builder;
  set_arguments(builder);
  const std::shared_ptr<External> external = builder.experimental().AddExternalConnectionAcceptor(
      grpc::ServerBuilder::experimental_type::ExternalConnectionType::FROM_FD,
      _state->credentials());
  builder.RegisterService(&_state->cases);
  builder.RegisterService(&_state->uploads);
  builder.RegisterService(&_state->meshes);
  builder.RegisterService(&_state->solves);
  builder.RegisterService(&_state->info);
  builder.experimental().SetInterceptorCreators(call_meters(options.call_ended));
  _state->server = builder.BuildAndStart();
  if (!_state->server) {
    throw errors::Error(errors::Reason::internal,
                        "gRPC does not start; see the server's error output");
  }
  _state->set_serving(true);
  _state->acceptor.start([external](int listener, int connection) {
    External::NewConnectionParameters parameters;
    parameters.listener_fd = listener;
    parameters.fd = connection;
    external->HandleNewConnection(&parameters);
  });
}

Server::~Server() {
  if (_state->server) drain(0ms);
}

const std::string& Server::address() const noexcept { return _state->acceptor.address(); }

void Server::replace(const Security& security) {
  if (_state->certificates && security.tls) _state->certificates->replace(*security.tls);
  _state->edge.authentication.replace(security.tokens);
}

void Server::announce(bool serving) { _state->set_serving(serving); }

void Server::drain(std::chrono::milliseconds grace) {
  std::call_once(_state->drained, [&] {
    _state->edge.admission.close();
    _state->set_serving(false);
    _state->edge.hub.close();
    _state->edge.backend.engine.stop(grace);
    _state->edge.hub.drain(draining_error(), stream_patience,
                           SteadyClock::now() + stream_patience + shutdown_patience);
    _state->acceptor.stop();
    _state->server->Shutdown(std::chrono::system_clock::now() + shutdown_patience);
    _state->server->Wait();
  });
}

Server::Metrics Server::metrics() const {
  const StreamCounts counts = _state->edge.hub.counts();
  const Acceptor::Counts connections = _state->acceptor.counts();
  return {counts.watchers,  counts.transfers,     _state->edge.hub.largest_lag(),
          connections.open, connections.accepted, connections.refused};
}

}  // namespace anticrack::rpc
