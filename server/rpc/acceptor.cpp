// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/acceptor.hpp"

#include <arpa/inet.h>
#include <fmt/core.h>
#include <grpc/support/log.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <exception>
#include <system_error>
#include <utility>
#include <vector>

#include "log/log.hpp"

namespace anticrack::rpc {
namespace {

using namespace std::chrono_literals;

/// The log says at most once in this time how many connections were refused.
constexpr auto between_words = 60s;
/// How long to wait if the system has no descriptors left, or has another fault that may pass.
constexpr auto breath = 100ms;
/// A peer that does not acknowledge sent data for this time counts as gone.
constexpr unsigned unacknowledged_ms = 10'000;

/// Logs gRPC's complaints, except those about connections that are reset before it looks at them:
/// strangers could fill the log with these.
void complain(gpr_log_func_args* said) {
  if (std::strstr(said->message, "getpeername") == nullptr)
    log::error("grpc", {{"message", said->message}});
}

/// The system's number of a socket; 0 if the descriptor is no socket.
std::uint64_t socket_number(int descriptor) {
  struct stat found {};
  return ::fstat(descriptor, &found) == 0 && S_ISSOCK(found.st_mode) ? found.st_ino : 0;
}

/// The user at the other end of a unix socket.
std::string local_user(int connection) {
  ucred who{};
  socklen_t size = sizeof(who);
  if (::getsockopt(connection, SOL_SOCKET, SO_PEERCRED, &who, &size) != 0) return "unix";
  return fmt::format("user {}", who.uid);
}

std::string text_of(int family, const void* address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  return ::inet_ntop(family, address, text.data(), text.size()) == nullptr ? "" : text.data();
}

/// The owner of a connection: the machine (for IPv6 the 64-bit network from which it may pick
/// addresses), or the user of this machine.
std::string owner_of(int connection, const sockaddr_storage& peer) {
  if (peer.ss_family == AF_INET)
    return text_of(AF_INET, &reinterpret_cast<const sockaddr_in&>(peer).sin_addr);
  if (peer.ss_family != AF_INET6) return local_user(connection);
  in6_addr address = reinterpret_cast<const sockaddr_in6&>(peer).sin6_addr;
  if (IN6_IS_ADDR_V4MAPPED(&address)) return text_of(AF_INET, &address.s6_addr[12]);
  if (IN6_IS_ADDR_LOOPBACK(&address)) return text_of(AF_INET6, &address);
  std::memset(&address.s6_addr[8], 0, 8);
  return text_of(AF_INET6, &address) + "/64";
}

void set_options(int connection, int family) {
  if (family == AF_UNIX) return;
  const int on = 1;
  ::setsockopt(connection, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  ::setsockopt(connection, IPPROTO_TCP, TCP_USER_TIMEOUT, &unacknowledged_ms,
               sizeof(unacknowledged_ms));
}

/// Whether an error of accept() says that a connection is gone already, or that none waits.
bool concerns_one_connection(int number) {
  return number == EINTR || number == ECONNABORTED || number == EPROTO || number == EPERM ||
         number == ENETDOWN || number == ENOPROTOOPT || number == EHOSTDOWN || number == ENONET ||
         number == EHOSTUNREACH || number == EOPNOTSUPP || number == ENETUNREACH;
}

base::Descriptor event() {
  base::Descriptor made(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (!made) throw std::system_error(errno, std::generic_category(), "cannot make an event");
  return made;
}

}  // namespace

Acceptor::Acceptor(const std::string& listen, ConnectionLimits limits)
    : _listener(std::in_place, listen),
      _address(_listener->address()),
      _wake(event()),
      _spare(event()),
      _table(limits, [](int descriptor, std::uint64_t socket) {
        return socket_number(descriptor) == socket;
      }) {
  gpr_set_log_function(complain);
}

Acceptor::~Acceptor() { stop(); }

void Acceptor::start(Take take) {
  _take = std::move(take);
  _thread = std::thread([this] { run(); });
}

void Acceptor::stop() {
  ::eventfd_write(_wake.get(), 1);
  if (_thread.joinable()) _thread.join();
  _listener.reset();
}

Acceptor::Counts Acceptor::counts() {
  const std::lock_guard lock(_mutex);
  Counts now = _counts;
  now.open = _table.open();
  return now;
}

void Acceptor::run() {
  std::vector<pollfd> polled{{_wake.get(), POLLIN, 0}};
  for (const base::Descriptor& socket : _listener->sockets())
    polled.push_back({socket.get(), POLLIN, 0});
  for (;;) {
    ::poll(polled.data(), polled.size(), -1);
    if (polled.front().revents != 0) return;
    for (std::size_t i = 1; i < polled.size(); ++i) {
      if (polled[i].revents == 0 || accept_one(polled[i].fd)) continue;
      ::poll(polled.data(), 1, static_cast<int>(breath.count()));
    }
  }
}

/// Accepts a connection; returns false if it is better to wait for a moment.
bool Acceptor::accept_one(int listener) {
  sockaddr_storage peer{};
  socklen_t size = sizeof(peer);
  const int connection = ::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (connection < 0) {
    if (errno == EAGAIN || concerns_one_connection(errno)) return true;
    return (errno == EMFILE || errno == ENFILE) && refuse_one(listener);
  }
  base::Descriptor owned(connection);
  // The connection is gone already, which gRPC would log each time.
  if (::getpeername(connection, reinterpret_cast<sockaddr*>(&peer), &size) != 0) return true;
  try {
    const std::string owner = owner_of(connection, peer);
    const std::uint64_t socket = socket_number(connection);
    std::unique_lock lock(_mutex);
    const Admitted admitted = _table.add(owner, connection, socket, ConnectionTable::Clock::now());
    ++(admitted == Admitted::yes ? _counts.accepted : _counts.refused);
    lock.unlock();
    if (admitted != Admitted::yes) {
      note_refusal(owner, admitted == Admitted::full
                              ? "as many are open as connections allows"
                              : "it has as many as connections-an-address and its share allow");
      return true;
    }
    set_options(connection, peer.ss_family);
    _take(listener, owned.release());
    return true;
  } catch (const std::exception&) {  // no memory
    return false;
  }
}

/// Closes a connection for which the process has no descriptor, so that its peer need not wait.
bool Acceptor::refuse_one(int listener) {
  _spare.reset();
  const bool refused =
      static_cast<bool>(base::Descriptor(::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC)));
  _spare.emplace(::eventfd(0, EFD_CLOEXEC));
  if (!refused) return false;
  std::unique_lock lock(_mutex);
  ++_counts.refused;
  lock.unlock();
  note_refusal("unknown", "no descriptor is left; raise LimitNOFILE or lower connections");
  return true;
}

void Acceptor::note_refusal(const std::string& address, const char* why) {
  ++_unsaid;
  const auto now = ConnectionTable::Clock::now();
  if (now < _next_word) return;
  log::warn("connections refused", {{"count", _unsaid}, {"last_of", address}, {"because", why}});
  _unsaid = 0;
  _next_word = now + between_words;
}

}  // namespace anticrack::rpc
