// SPDX-License-Identifier: GPL-3.0-or-later
#include "postgres/listener.hpp"

#include <poll.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "stop/stop.hpp"

namespace anticrack::postgres {

namespace {

using Clock = std::chrono::steady_clock;

/// A connection on which nothing comes may be dead.
constexpr std::chrono::seconds ask_every{5};
constexpr std::chrono::milliseconds look_at_stop_every{100}, longest_pause{2'000};

}  // namespace

Listener::Listener(Settings settings, std::vector<std::string> channels, Heard heard)
    : _settings(std::move(settings)),
      _channels(std::move(channels)),
      _heard(std::move(heard)),
      _thread([this](const std::stop_token& stop) {
        const stop::Scope scope(stop);
        const std::vector<Options>& servers = _settings.address.servers();
        std::chrono::milliseconds delay = look_at_stop_every;
        for (std::size_t server = 0; !stop.stop_requested(); ++server) {
          const auto begin = Clock::now();
          try {
            listen(stop, servers[server % servers.size()]);
          } catch (const errors::Error&) {
            // The next attempt tells whether the database is back.
          }
          delay = Clock::now() - begin > ask_every ? look_at_stop_every
                                                   : std::min(2 * delay, longest_pause);
          for (const auto until = Clock::now() + delay;
               Clock::now() < until && !stop.stop_requested();)
            std::this_thread::sleep_for(look_at_stop_every);
        }
      }) {}

void Listener::listen(const std::stop_token& stop, const Options& server) {
  Connection connection(_settings, server);
  for (const std::string& channel : _channels) connection.execute("LISTEN " + channel);
  for (const std::string& channel : _channels) _heard(channel, {});
  std::string channel, payload;
  for (auto asked = Clock::now(); !stop.stop_requested();) {
    pollfd one{connection.socket(), POLLIN, 0};
    ::poll(&one, 1, static_cast<int>(look_at_stop_every.count()));
    if (const auto now = Clock::now(); now - asked > ask_every) {
      connection.execute("SELECT 1");
      asked = now;
    }
    while (connection.notification(channel, payload)) _heard(channel, payload);
  }
}

}  // namespace anticrack::postgres
