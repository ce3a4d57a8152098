// SPDX-License-Identifier: GPL-3.0-or-later
//
// Values of settings as text. A text that cannot be read throws std::invalid_argument with one
// sentence: the value and the cure.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace anticrack::app {

/// Bytes from "4G", "512 MiB", "1.5GiB" or "1000000", at least `least`. K, M, G, T are powers of
/// 1000, Ki, Mi, Gi, Ti of 1024; a B at the end is optional.
std::uint64_t to_bytes(const std::string& text, std::uint64_t least = 0);
/// The shortest text that to_bytes reads back exactly.
std::string from_bytes(std::uint64_t bytes);

/// An integer within [least, most].
std::int64_t to_integer(const std::string& text, std::int64_t least, std::int64_t most);

/// A time from "90s", "5m", "12h", "7d", or seconds: "3", "0.5". From `least` (>= 0) to 30 days.
std::chrono::milliseconds to_time(const std::string& text,
                                  std::chrono::milliseconds least = std::chrono::milliseconds(0));
/// The shortest text that to_time reads back exactly.
std::string from_time(std::chrono::milliseconds time);

/// The value of "true" or "false".
bool to_flag(const std::string& text);

}  // namespace anticrack::app
