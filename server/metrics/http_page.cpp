// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/http_page.hpp"

#include <fmt/core.h>
#include <microhttpd.h>
#include <netdb.h>
#include <sys/socket.h>

#include <cerrno>
#include <deque>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

namespace anticrack::metrics {
namespace {

/// Most connections; with more, the oldest one is closed, so that a new one never waits.
constexpr std::size_t most_connections = 64;
/// Descriptors, including those of connections that are being closed.
constexpr unsigned most_descriptors = 2 * most_connections;
constexpr unsigned idle_seconds = 10;

template <auto release>
struct Release {
  void operator()(auto* object) const { release(object); }
};
using Addresses = std::unique_ptr<addrinfo, Release<freeaddrinfo>>;
using Response = std::unique_ptr<MHD_Response, Release<MHD_destroy_response>>;

Addresses resolve(std::string host, const std::string& port) {
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* list = nullptr;
  if (const int problem = ::getaddrinfo(host.c_str(), port.c_str(), &hints, &list); problem != 0)
    throw std::runtime_error(::gai_strerror(problem));
  return Addresses(list);
}

MHD_Result respond(MHD_Connection* connection, unsigned status, const std::string& body,
                   const std::string& type) {
  // MHD copies the body and does not change it, whatever its signature says.
  const Response response(MHD_create_response_from_buffer(
      body.size(), const_cast<char*>(body.data()), MHD_RESPMEM_MUST_COPY));
  if (!response) return MHD_NO;
  MHD_add_response_header(response.get(), MHD_HTTP_HEADER_CONTENT_TYPE, type.c_str());
  return MHD_queue_response(connection, status, response.get());
}

}  // namespace

struct HttpPage::State {
  std::deque<int> connections;  ///< their descriptors, the oldest first; used by MHD's thread alone
  std::string path;
  std::string content_type;
  std::function<std::string()> make;
  std::function<bool()> ready;
  std::string address;
  std::unique_ptr<MHD_Daemon, Release<MHD_stop_daemon>>
      daemon;  ///< declared last: it uses the others

  /// Notes connections and closes the oldest: clients that ask for nothing, or very slowly, must
  /// not keep out others.
  static void note(void* self, MHD_Connection* connection, void** /*kept*/,
                   MHD_ConnectionNotificationCode what) {
    auto& open = static_cast<State*>(self)->connections;
    const int socket =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD)->connect_fd;
    if (what == MHD_CONNECTION_NOTIFY_CLOSED) {
      std::erase(open, socket);
      return;
    }
    open.push_back(socket);
    if (open.size() <= most_connections) return;
    ::shutdown(open.front(), SHUT_RDWR);
    open.pop_front();
  }

  static MHD_Result answer(void* self, MHD_Connection* connection, const char* url,
                           const char* method, const char* /*version*/, const char* /*upload*/,
                           std::size_t* upload_bytes, void** seen) {
    // The first call only announces the request; a response to it would close the connection.
    if (*seen == nullptr) {
      *seen = self;
      return MHD_YES;
    }
    if (*upload_bytes != 0) {  // a body is ignored
      *upload_bytes = 0;
      return MHD_YES;
    }
    const State& page = *static_cast<const State*>(self);
    const std::string_view verb = method;
    if (verb != MHD_HTTP_METHOD_GET && verb != MHD_HTTP_METHOD_HEAD)
      return respond(connection, MHD_HTTP_METHOD_NOT_ALLOWED, "GET only\n", "text/plain");
    if (std::string_view(url) == "/ready") {
      const bool ready = page.ready();
      return respond(connection, ready ? MHD_HTTP_OK : MHD_HTTP_SERVICE_UNAVAILABLE,
                     ready ? "ready\n" : "not ready\n", "text/plain");
    }
    if (page.path != url) {
      return respond(connection, MHD_HTTP_NOT_FOUND, "there is only " + page.path + " and /ready\n",
                     "text/plain");
    }
    return respond(connection, MHD_HTTP_OK, page.make(), page.content_type);
  }
};

HttpPage::HttpPage(const std::string& address, std::string path, std::string content_type,
                   std::function<std::string()> make, std::function<bool()> ready)
    : _state(std::make_unique<State>()) {
  _state->path = std::move(path);
  _state->content_type = std::move(content_type);
  _state->make = std::move(make);
  _state->ready = std::move(ready);

  const std::size_t colon = address.rfind(':');
  if (colon == std::string::npos) throw std::runtime_error("not HOST:PORT");
  const auto where = resolve(address.substr(0, colon), address.substr(colon + 1));
  const unsigned family = where->ai_family == AF_INET6 ? MHD_USE_IPv6 : 0;
  errno = 0;
  _state->daemon.reset(MHD_start_daemon(
      MHD_USE_AUTO | MHD_USE_INTERNAL_POLLING_THREAD | family, 0, nullptr, nullptr, &State::answer,
      _state.get(), MHD_OPTION_SOCK_ADDR, where->ai_addr, MHD_OPTION_NOTIFY_CONNECTION,
      &State::note, _state.get(), MHD_OPTION_CONNECTION_LIMIT, most_descriptors,
      MHD_OPTION_CONNECTION_TIMEOUT, idle_seconds, MHD_OPTION_END));
  if (!_state->daemon) throw std::runtime_error(std::generic_category().message(errno));
  const MHD_DaemonInfo* port = MHD_get_daemon_info(_state->daemon.get(), MHD_DAEMON_INFO_BIND_PORT);
  _state->address = fmt::format("{}{}", address.substr(0, colon + 1), port->port);
}

HttpPage::~HttpPage() = default;

const std::string& HttpPage::address() const noexcept { return _state->address; }

}  // namespace anticrack::metrics
