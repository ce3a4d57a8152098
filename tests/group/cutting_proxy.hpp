// SPDX-License-Identifier: GPL-3.0-or-later
//
// A proxy before PostgreSQL that cuts one connection at a chosen statement.
#pragma once

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <array>
#include <atomic>
#include <cstring>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "base/descriptor.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::testing {

/// Listens on a Unix socket in a folder of its own, as PostgreSQL does in `server`.
class CuttingProxy {
 public:
  /// Cuts the connection on which the `at`-th request comes (from 1 on, over all connections; a
  /// request is what the server answers with "ready"): before the server has it or, if
  /// `reply_lost`, when it has answered.
  CuttingProxy(std::string server, int at, bool reply_lost)
      : _server(std::move(server)), _at(at), _reply_lost(reply_lost) {
    const sockaddr_un name = name_in(folder.path());
    if (::bind(_listening.get(), reinterpret_cast<const sockaddr*>(&name), sizeof name) != 0 ||
        ::listen(_listening.get(), 50) != 0)
      throw std::runtime_error("cannot listen");
    _accepting = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested())
        if (readable(_listening, 20))
          _connections.emplace_back(
              [this, client = base::Descriptor(::accept(_listening.get(), nullptr, nullptr))](
                  const std::stop_token& stopped) { serve(client, stopped); });
    });
  }

  bool has_cut() const noexcept { return _requests >= _at; }

  const TemporaryFolder folder;

 private:
  static sockaddr_un name_in(const std::string& place) {
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    (place + "/.s.PGSQL.5432").copy(name.sun_path, sizeof name.sun_path - 1);
    return name;
  }
  static bool readable(const base::Descriptor& socket, int milliseconds) {
    pollfd one{socket.get(), POLLIN, 0};
    return ::poll(&one, 1, milliseconds) > 0;
  }
  static bool send(const base::Descriptor& to, std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t count = ::send(to.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (count <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
  }
  static std::string receive(const base::Descriptor& from) {
    std::string bytes(1 << 16, '\0');
    const ssize_t count = ::recv(from.get(), bytes.data(), bytes.size(), 0);
    bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return bytes;
  }

  /// The bytes of whole messages at the front of `pending` up to and with the next request; 0:
  /// none.
  static std::size_t next_message(const std::string& pending, bool started) {
    const std::size_t head = started ? 1 : 0;  // the first message has no type
    if (pending.size() < head + 4) return 0;
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i)
      length = (length << 8U) | static_cast<unsigned char>(pending[head + i]);
    return pending.size() < head + length ? 0 : head + length;
  }

  void serve(const base::Descriptor& client, const std::stop_token& stop) {
    const base::Descriptor server(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
    const sockaddr_un name = name_in(_server);
    if (::connect(server.get(), reinterpret_cast<const sockaddr*>(&name), sizeof name) != 0) return;
    std::string pending;
    bool started = false;
    while (!stop.stop_requested()) {
      std::array<pollfd, 2> both{{{client.get(), POLLIN, 0}, {server.get(), POLLIN, 0}}};
      if (::poll(both.data(), both.size(), 20) <= 0) continue;
      if (both[1].revents != 0) {
        const std::string bytes = receive(server);
        if (bytes.empty() || !send(client, bytes)) return;
      }
      if (both[0].revents == 0) continue;
      const std::string bytes = receive(client);
      if (bytes.empty()) return;
      pending += bytes;
      while (const std::size_t size = next_message(pending, started)) {
        const bool request = started && (pending[0] == 'Q' || pending[0] == 'S');
        started = true;
        const bool cut = request && ++_requests == _at;
        if (cut && !_reply_lost) return;
        if (!send(server, std::string_view(pending).substr(0, size))) return;
        pending.erase(0, size);
        if (cut) {
          // The end of the answer: ready, with the state of the transaction.
          for (std::string answer; answer.find("Z\0\0\0\5", 0, 5) == std::string::npos;) {
            const std::string more = receive(server);
            if (more.empty()) break;
            answer += more;
          }
          return;
        }
      }
    }
  }

  const std::string _server;
  const int _at;
  const bool _reply_lost;
  std::atomic<int> _requests{0};
  const base::Descriptor _listening{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  std::vector<std::jthread> _connections;
  std::jthread _accepting;
};

}  // namespace anticrack::testing
