// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/notify.hpp"

#include <systemd/sd-daemon.h>

#include <algorithm>
#include <cstdint>

namespace anticrack::app {

bool notify_ready(const std::string& status) {
  return sd_notify(0, ("READY=1\nSTATUS=" + status).c_str()) >= 0;
}

void notify_stopping(const std::string& status) {
  sd_notify(0, ("STOPPING=1\nSTATUS=" + status).c_str());
}

void notify_alive() { sd_notify(0, "WATCHDOG=1"); }

std::optional<std::chrono::milliseconds> watchdog_interval() {
  std::uint64_t microseconds = 0;
  if (sd_watchdog_enabled(0, &microseconds) <= 0) return std::nullopt;
  // Half of the limit, as sd_watchdog_enabled(3) advises.
  return std::max(std::chrono::milliseconds(1), std::chrono::milliseconds(microseconds / 2000));
}

}  // namespace anticrack::app
