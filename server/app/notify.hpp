// SPDX-License-Identifier: GPL-3.0-or-later
//
// Messages to systemd. Without systemd (no NOTIFY_SOCKET) they do nothing.
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace anticrack::app {

/// Tell that the server accepts calls; that it stops; that it is not stuck. `status`: a line for
/// systemctl status. They return false if nothing listens at NOTIFY_SOCKET.
bool notify_ready(const std::string& status);
void notify_stopping(const std::string& status);
void notify_alive();

/// How often to call notify_alive() for systemd's watchdog; none: never.
std::optional<std::chrono::milliseconds> watchdog_interval();

}  // namespace anticrack::app
