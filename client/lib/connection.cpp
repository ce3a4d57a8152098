// SPDX-License-Identifier: GPL-3.0-or-later
#include "client/connection.hpp"

#include <algorithm>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <string_view>
#include <utility>

#include "client/channel.hpp"

namespace anticrack::client {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr std::size_t most_jobs_known = 10'000;

std::shared_ptr<grpc::ChannelCredentials> credentials_of(const Credentials& credentials) {
  if (!credentials.tls) return grpc::InsecureChannelCredentials();
  return grpc::SslCredentials({credentials.roots, credentials.key, credentials.certificate});
}

std::shared_ptr<grpc::Channel> make_channel(const ConnectionOptions& options, bool proxy,
                                            bool bulk) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, proxy ? 1 : 0);
  // Heartbeats come every 10 s; a stream silent for longer may hang on a dead connection. The
  // server refuses shorter periods as abuse ("too many pings").
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, 30'000);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 10'000);
  // gRPC's own back-off reaches minutes, but it must try to connect as often as our back-off does.
  const auto longest =
      static_cast<int>(std::clamp<std::int64_t>(options.retry.longest.count(), 100, 1'000));
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 1'000);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, longest);
  // The answer to a case may have two requests of the size that the server accepts.
  arguments.SetMaxReceiveMessageSize(-1);
  // A different argument, as channels with equal arguments share one connection.
  arguments.SetInt("anticrack.bulk", bulk ? 1 : 0);
  return grpc::CreateCustomChannel(options.address, credentials_of(options.credentials), arguments);
}

// Waits at most for `time`. gRPC reconnects promptly only while a thread waits on the channel;
// after a plain sleep it would reconnect seconds late.
void wait_for_connection(grpc::Channel& channel, milliseconds time, const std::stop_token& stop) {
  constexpr milliseconds slice{50};  // delay with which a stop is noticed
  const auto end = std::chrono::system_clock::now() + time;
  while (!stop.stop_requested()) {
    const auto next = std::min(end, std::chrono::system_clock::now() + slice);
    if (channel.WaitForConnected(next) || next == end) return;
  }
  throw Interrupted();
}

bool has(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

// The cause, which gRPC puts last.
std::string_view cause_of(std::string_view story) {
  const std::size_t cause = story.rfind(": ");
  return cause == std::string_view::npos ? story : story.substr(cause + 2);
}

std::string roots_of(const Credentials& credentials) {
  return credentials.files.ca.empty()
             ? std::string("the roots of this system; name its own with --ca FILE")
             : "--ca " + credentials.files.ca.string();
}

std::string tls_cure(const std::string& address, const Credentials& credentials,
                     std::string_view story) {
  // OpenSSL 3.0 and 3.5 may report this for a signature by another authority of the same name.
  const bool no_signature = (has(story, "asn1 encoding routines") && has(story, "EVP lib")) ||
                            has(story, "provider signature failure");
  if (no_signature || has(story, "CERTIFICATE_VERIFY_FAILED") ||
      has(story, "certificate verify failed")) {
    return "the certificate of " + address + " is not signed by " + roots_of(credentials) +
           ", or it has expired";
  }
  if (has(story, "is not in peer certificate") || has(story, "Hostname Verification")) {
    return "the certificate of the server is for another name than " + address +
           "; use the name it was made for, or make it again with this one";
  }
  if (has(story, "WRONG_VERSION_NUMBER") || has(story, "wrong version number")) {
    return address +
           " speaks no TLS; leave out --tls, --ca and --cert, or give the server a "
           "certificate";
  }
  if (has(story, "alert") || (has(story, "andshake") && credentials.certificate.empty())) {
    return credentials.certificate.empty()
               ? std::string("the server wants a certificate; give --cert FILE and --key FILE")
               : "the server does not accept the certificate in " +
                     credentials.files.certificate.string() + "; is it signed by its authority?";
  }
  return "";
}

std::string proxy_remark(const Proxy& proxy) {
  return proxy.variable + " sends what goes there through the proxy " + proxy.server +
         ": for a server that is reached without it add its host to no_proxy";
}

/// Why the server cannot be reached and what to check. `story`: gRPC's own message, cause last.
std::string unreachable_text(const Connection::State& state, std::string_view story) {
  const std::string& address = state.options.address;
  const Credentials& credentials = state.options.credentials;
  const std::string head =
      "cannot reach the server at " + address + " (" + std::string(cause_of(story)) + "); ";
  if (credentials.tls) {
    const std::string cure = tls_cure(address, credentials, story);
    if (!cure.empty()) return head + cure;
  }
  if (state.proxy) return head + proxy_remark(*state.proxy);
  // A server with TLS closes connections without TLS.
  const bool hung_up = has(story, "ocket closed") || has(story, "onnection reset") ||
                       has(story, "HTTP2") || has(story, "HTTP/2");
  return head + (hung_up && !credentials.tls
                     ? "is it anticrackd? If it wants TLS, add --ca FILE or --tls"
                     : "start anticrackd, name its address with --server, or use --local");
}

/// Text for UNAUTHENTICATED and PERMISSION_DENIED: the server's message, and the option to cure it.
std::string refused_text(Code code, const std::string& message, const Credentials& credentials) {
  const std::string file = credentials.files.token.string();
  const std::string token = file.empty() ? "in ANTICRACK_TOKEN" : "in " + file;
  if (code == Code::permission_denied) {
    return message + (credentials.token.empty()
                          ? "; to log in as another user give another --cert, or --token-file FILE"
                          : "; to log in as another user replace the token " + token);
  }
  return message + (credentials.token.empty()
                        ? "; give a token with --token-file FILE or in ANTICRACK_TOKEN"
                        : "; check the token " + token);
}

}  // namespace

Connection::State::State(ConnectionOptions chosen) : options(std::move(chosen)) {
  proxy = proxy_for(options.address, [](const char* name) { return std::getenv(name); });
  channel = make_channel(options, proxy.has_value(), false);
  bulk = make_channel(options, proxy.has_value(), true);
}

Connection::Connection(ConnectionOptions options)
    : _state(std::make_unique<State>(std::move(options))) {}

Connection::~Connection() = default;

const std::string& Connection::address() const noexcept { return _state->options.address; }

std::string Connection::State::mesh_of(const std::string& name) {
  if (name.starts_with("meshes/")) return name;
  const std::lock_guard lock(_mutex);
  const auto found = _meshes.find(name);
  return found == _meshes.end() ? std::string() : found->second;
}

void Connection::State::learn(const v1::Job& job) {
  const std::lock_guard lock(_mutex);
  if (_meshes.size() >= most_jobs_known) _meshes.clear();
  _meshes[job.name()] = job.spec().mesh();
}

void prepare(const Connection::State& state, grpc::ClientContext& context,
             const std::string& mesh) {
  // Names come from users, and gRPC ends the program over a value that is no text.
  constexpr std::string_view collection = "meshes/",
                             of_ids =
                                 "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
  constexpr std::size_t longest_id = 64;
  if (mesh.starts_with(collection) &&
      mesh.find_first_not_of(of_ids, collection.size()) == std::string::npos) {
    const std::string id = mesh.substr(collection.size());
    if (!id.empty() && id.size() <= longest_id) context.AddMetadata("x-mesh-id", id);
  }
  // The token is not sent as call credentials, which gRPC sends over TLS only, because localhost
  // and unix sockets need no TLS.
  if (!state.options.credentials.token.empty())
    context.AddMetadata("authorization", "Bearer " + state.options.credentials.token);
}

Error error_of(const Connection::State& state, const grpc::Status& status) {
  const int code = static_cast<int>(status.error_code());
  Error error = decode_error(code, status.error_message(), status.error_details());
  const ConnectionOptions& options = state.options;
  if (error.code() == Code::unavailable && error.details().reason.empty()) {
    return Error(error.code(), unreachable_text(state, status.error_message()));
  }
  if (error.code() == Code::unauthenticated || error.code() == Code::permission_denied) {
    return Error(error.code(), refused_text(error.code(), error.what(), options.credentials),
                 error.details());
  }
  if (error.code() == Code::deadline_exceeded) {
    return Error(error.code(),
                 "the server at " + options.address + " did not answer in time (" +
                     status.error_message() + ")" +
                     (state.proxy ? "; " + proxy_remark(*state.proxy) : ""),
                 error.details());
  }
  return error;
}

Retries::Retries(Connection::State& state, grpc::Channel& channel)
    : _state(state), _channel(channel), _backoff(state.options.retry) {}

void Retries::wait(const grpc::Status& status, const std::stop_token& stop) {
  if (stop.stop_requested()) throw Interrupted();
  const Error error = status.ok() ? Error(Code::unavailable, "the server closed the stream early")
                                  : error_of(_state, status);
  const bool lost = is_lost_connection(error);
  _lost = _lost || lost;
  if (_state.options.lost && lost) _state.options.lost();
  const auto now = steady_clock::now();
  if (!_failing_since) {
    _failing_since = now;
    _first_error = error;
  }
  const auto failing = std::chrono::duration_cast<milliseconds>(now - *_failing_since);
  const milliseconds patience =
      lost && !_state.met ? _state.options.first_contact : _state.options.retry.patience;
  const auto delay = _backoff.next(error, failing, patience);
  if (!delay) {
    // For a lost connection, report the first cause ("connection refused"): later ones come from
    // gRPC's own attempts to reconnect.
    throw lost && is_lost_connection(*_first_error) ? *_first_error : error;
  }
  if (_state.options.notice)
    _state.options.notice(retry_text(error, _state.options.address, patience));
  if (lost && _channel.GetState(false) != GRPC_CHANNEL_READY)
    wait_for_connection(_channel, *delay, stop);
  else
    sleep(*delay, stop);  // needed because a proxy that lost the server still holds our connection
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
