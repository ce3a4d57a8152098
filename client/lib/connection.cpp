// SPDX-License-Identifier: GPL-3.0-or-later
#include "client/connection.hpp"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <string_view>
#include <utility>

#include "client/channel.hpp"
#include "client/failure_text.hpp"

namespace anticrack::client {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

std::shared_ptr<grpc::ChannelCredentials> credentials_of(const Credentials& credentials) {
  if (!credentials.tls) return grpc::InsecureChannelCredentials();
  return grpc::SslCredentials({credentials.roots, credentials.key, credentials.certificate});
}

std::shared_ptr<grpc::Channel> make_channel(const ConnectionOptions& options, bool bulk) {
  grpc::ChannelArguments arguments;
  // Heartbeats come every 10 s; a stream silent for longer may hang on a dead connection. Shorter
  // periods are taken for abuse by the server ("too many pings").
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, 30'000);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 10'000);
  // gRPC's own back-off reaches minutes; ours decides, so its connection is to be tried as often.
  const auto longest =
      static_cast<int>(std::clamp<std::int64_t>(options.retry.longest.count(), 100, 1'000));
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 1'000);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, longest);
  // Channels of equal arguments share one connection.
  arguments.SetInt("anticrack.bulk", bulk ? 1 : 0);
  return grpc::CreateCustomChannel(options.address, credentials_of(options.credentials), arguments);
}

// At most for `time`. gRPC works at a connection while somebody waits on the channel and hardly at
// all while everybody sleeps: a sleeping client finds its server again seconds late.
void wait_for_connection(grpc::Channel& channel, milliseconds time, const std::stop_token& stop) {
  constexpr milliseconds slice{50};  // a stop has to be heard
  const auto end = std::chrono::system_clock::now() + time;
  while (!stop.stop_requested()) {
    const auto next = std::min(end, std::chrono::system_clock::now() + slice);
    if (channel.WaitForConnected(next) || next == end) return;
  }
  throw Interrupted();
}

}  // namespace

Connection::State::State(ConnectionOptions chosen) : options(std::move(chosen)) {
  channel = make_channel(options, false);
  meshes = v1::MeshService::NewStub(channel);
  jobs = v1::SolveService::NewStub(channel);
  server = v1::ServerService::NewStub(channel);
  bulk = make_channel(options, true);
  bulk_meshes = v1::MeshService::NewStub(bulk);
  bulk_jobs = v1::SolveService::NewStub(bulk);
}

Connection::Connection(ConnectionOptions options)
    : _state(std::make_unique<State>(std::move(options))) {}

Connection::~Connection() = default;

const std::string& Connection::address() const noexcept {
  return _state->options.address;
}

void authorise(const Connection::State& state, grpc::ClientContext& context) {
  // Not as call credentials: gRPC sends those over TLS only, and a trial on the own machine, or a
  // unix socket, needs none.
  if (!state.options.credentials.token.empty())
    context.AddMetadata("authorization", "Bearer " + state.options.credentials.token);
}

Error error_of(const Connection::State& state, const grpc::Status& status) {
  const int code = static_cast<int>(status.error_code());
  Error error = decode_error(code, status.error_message(), status.error_details());
  const ConnectionOptions& options = state.options;
  if (error.code() == Code::unavailable && error.details().reason.empty()) {
    return Error(error.code(),
                 unreachable_text(options.address, options.credentials, status.error_message()));
  }
  if (error.code() == Code::unauthenticated || error.code() == Code::permission_denied) {
    return Error(error.code(), refused_text(error.code(), error.what(), options.credentials),
                 error.details());
  }
  if (error.code() == Code::deadline_exceeded) {
    return Error(error.code(),
                 "the server at " + options.address + " did not answer in time (" +
                     status.error_message() + ")",
                 error.details());
  }
  return error;
}

Retries::Retries(Connection::State& state, grpc::Channel& channel)
    : _state(state), _channel(channel), _backoff(state.options.retry) {}

void Retries::wait(const Error& error, const std::stop_token& stop) {
  if (stop.stop_requested()) throw Interrupted();
  const auto now = steady_clock::now();
  if (!_failing_since) {
    _failing_since = now;
    _first_error = error;
  }
  const auto failing = std::chrono::duration_cast<milliseconds>(now - *_failing_since);
  const bool lost = is_lost_connection(error);
  const milliseconds patience =
      lost && !_state.met ? _state.options.first_contact : _state.options.retry.patience;
  const auto delay = _backoff.next(error, failing, patience);
  if (!delay) {
    // Of a lost connection the first cause tells most ("connection refused"); later ones are
    // gRPC's own attempts getting in each other's way.
    throw lost && is_lost_connection(*_first_error) ? *_first_error : error;
  }
  if (_state.options.notice)
    _state.options.notice(retry_text(error, _state.options.address, patience));
  if (lost && _channel.GetState(false) != GRPC_CHANNEL_READY)
    wait_for_connection(_channel, *delay, stop);
  else
    sleep(*delay, stop);  // a proxy keeps its connection to us and loses the server's
}

void Retries::succeeded() {
  _state.met = true;
  _failing_since.reset();
  _backoff.reset();
}

void sleep(milliseconds time, const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any woken;
  std::unique_lock lock(mutex);
  woken.wait_for(lock, stop, time, [] { return false; });
  if (stop.stop_requested()) throw Interrupted();
}

}  // namespace anticrack::client
