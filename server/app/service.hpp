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
  /// Cancels what still runs.
  ~Service();

  /// HOST:PORT with the real port, or unix:PATH.
  const std::string& address() const noexcept;
  /// Stops gently within the configuration's drain-time and a little.
  void drain();

 private:
  struct Parts;
  std::unique_ptr<Parts> _parts;
};

}  // namespace anticrack::app
