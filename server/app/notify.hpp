// SPDX-License-Identifier: GPL-3.0-or-later
//
// What systemd is told; without systemd (no NOTIFY_SOCKET) nothing happens.
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace anticrack::app {

/// Tell systemd, where it started this process, else nobody: that calls are taken, that no more
/// will be, that the process is not stuck. `status`: a line for systemctl status.
void notify_ready(const std::string& status);
void notify_stopping(const std::string& status);
void notify_alive();

/// How often systemd's watchdog wants to hear notify_alive(); none: never.
std::optional<std::chrono::milliseconds> watchdog_interval();

}  // namespace anticrack::app
