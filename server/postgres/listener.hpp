// SPDX-License-Identifier: GPL-3.0-or-later
//
// Hears notifications (LISTEN) on a connection of its own.
#pragma once

#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "postgres/connection.hpp"

namespace anticrack::postgres {

class Listener {
 public:
  /// Called on the listener's thread; must be quick and not throw. An empty payload comes for each
  /// channel whenever the listener has connected: something may have been missed before.
  using Heard = std::function<void(const std::string& channel, const std::string& payload)>;

  /// Starts the thread, which connects again as often as it must. `channels`: names of lower-case
  /// letters and underscores.
  Listener(Settings settings, std::vector<std::string> channels, Heard heard);

 private:
  void listen(const std::stop_token& stop, const Options& server);

  const Settings _settings;
  const std::vector<std::string> _channels;
  const Heard _heard;
  std::jthread _thread;
};

}  // namespace anticrack::postgres
