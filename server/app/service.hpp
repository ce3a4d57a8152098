// SPDX-License-Identifier: GPL-3.0-or-later
//
// Connects the server's parts; it decides nothing itself.
#pragma once

#include <memory>
#include <string>

#include "app/config.hpp"

namespace anticrack::app {

class Service {
 public:
  /// Starts everything up to listening. Throws ConfigError or errors::Error.
  explicit Service(const Config& config);
  /// Stops at once, in this order: metrics, calls, jobs, meshes, operators, the store. Unfinished
  /// jobs are queued again at the next start.
  ~Service();

  /// HOST:PORT with the real port, or unix:PATH.
  const std::string& address() const noexcept;
  /// Takes the lock of every part. If one of them is stuck, it does not return, so that systemd's
  /// watchdog ends the process.
  void check_alive() const noexcept;
  /// Reads certificates, key and tokens again; new connections and calls use them. If one of them
  /// is bad, all old ones stay. The log says what happened and why.
  void reload() noexcept;
  /// Serves as not ready for drain-delay, then stops gently in about drain-time.
  void drain();

 private:
  struct Parts;
  std::unique_ptr<Parts> _parts;
};

}  // namespace anticrack::app
