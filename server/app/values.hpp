// SPDX-License-Identifier: GPL-3.0-or-later
//
// Values of settings as people write them. What cannot be read throws std::invalid_argument with
// one sentence that gives the value and the cure.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace anticrack::app {

/// "4G", "512 MiB", "1.5GiB", "1000000": decimal suffixes K, M, G, T (with or without B) are powers
/// of 1000, Ki, Mi, Gi, Ti (with or without B) of 1024.
std::uint64_t to_bytes(const std::string& text);
/// The shortest text that to_bytes reads back exactly.
std::string from_bytes(std::uint64_t bytes);

/// An integer within [least, most].
std::int64_t to_integer(const std::string& text, std::int64_t least, std::int64_t most);

/// "90s", "5m", "12h", "7d"; a bare number is seconds: "3", "0.5". Not negative, at most 30 days.
std::chrono::milliseconds to_time(const std::string& text);
/// The shortest text that to_time reads back exactly.
std::string from_time(std::chrono::milliseconds time);

/// "true" or "false".
bool to_flag(const std::string& text);

}  // namespace anticrack::app
