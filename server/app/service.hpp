// SPDX-License-Identifier: GPL-3.0-or-later
//
// Wires the server's parts together; decides nothing.
#pragma once

#include <memory>
#include <string>

#include "app/config.hpp"

namespace anticrack::app {

class Service {
 public:
  /// Everything up to listening. Throws ConfigError or errors::Error.
  explicit Service(const Config& config);
  /// Stops at once: metrics first, then calls, jobs, meshes, operators, the store. Jobs that have
  /// not ended are queued again at the next start.
  ~Service();

  /// HOST:PORT with the real port, or unix:PATH.
  const std::string& address() const noexcept;
  /// Returns once every part has answered a question that takes its lock: one that is stuck keeps
  /// it waiting, and so keeps systemd's watchdog from hearing of it.
  void check_alive() const noexcept;
  /// Not ready any more, and serving on for drain-delay; then stops gently within drain-time and a
  /// little.
  void drain();

 private:
  struct Parts;
  std::unique_ptr<Parts> _parts;
};

}  // namespace anticrack::app
