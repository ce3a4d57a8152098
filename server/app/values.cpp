// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/values.hpp"

#include <fmt/core.h>

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>

namespace anticrack::app {
namespace {

struct Unit {
  std::string_view name;
  std::int64_t size;
};

constexpr std::array<Unit, 9> byte_units{{{"", 1},
                                          {"K", 1'000},
                                          {"M", 1'000'000},
                                          {"G", 1'000'000'000},
                                          {"T", 1'000'000'000'000},
                                          {"Ki", 1LL << 10},
                                          {"Mi", 1LL << 20},
                                          {"Gi", 1LL << 30},
                                          {"Ti", 1LL << 40}}};

constexpr std::array<Unit, 5> time_units{
    {{"d", 86'400}, {"h", 3'600}, {"m", 60}, {"s", 1}, {"", 1}}};

/// The value of "1.5 UNIT" in units of size 1; none unless the text is a finite number >= 0 and one
/// of the units.
std::optional<double> measure(std::string_view text, std::span<const Unit> units) {
  double number = 0;
  const auto [stop, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (problem != std::errc() || !std::isfinite(number) || std::signbit(number)) return std::nullopt;
  std::string_view name = text.substr(static_cast<std::size_t>(stop - text.data()));
  while (name.starts_with(' ')) name.remove_prefix(1);
  for (const Unit& unit : units)
    if (name == unit.name) return number * static_cast<double>(unit.size);
  return std::nullopt;
}

}  // namespace

std::uint64_t to_bytes(const std::string& text, std::uint64_t least) {
  std::string_view number = text;
  if (number.ends_with('B')) number.remove_suffix(1);
  const std::optional<double> value = measure(number, byte_units);
  if (!value || *value >= std::ldexp(1.0, 63)) {
    throw std::invalid_argument(
        fmt::format("\"{}\" is not a number of bytes; write e.g. 2GiB or 500M", text));
  }
  const auto bytes = static_cast<std::uint64_t>(std::llround(*value));
  if (bytes >= least) return bytes;
  throw std::invalid_argument(
      fmt::format("\"{}\" is too small; give at least {}", text, from_bytes(least)));
}

std::string from_bytes(std::uint64_t bytes) {
  for (std::size_t i = byte_units.size(); i-- > 5;) {
    const auto size = static_cast<std::uint64_t>(byte_units[i].size);
    if (bytes != 0 && bytes % size == 0)
      return fmt::format("{}{}B", bytes / size, byte_units[i].name);
  }
  return std::to_string(bytes);
}

std::int64_t to_integer(const std::string& text, std::int64_t least, std::int64_t most) {
  std::int64_t value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, value);
  if (problem != std::errc() || stop != end || value < least || value > most) {
    throw std::invalid_argument(
        fmt::format("\"{}\" is not an integer between {} and {}", text, least, most));
  }
  return value;
}

std::chrono::milliseconds to_time(const std::string& text, std::chrono::milliseconds least) {
  constexpr double longest = 30 * 86'400.0;
  const std::optional<double> seconds = measure(text, time_units);
  if (!seconds || *seconds > longest) {
    throw std::invalid_argument(fmt::format(
        "\"{}\" is not a time of at most 30 days; write e.g. 0.5, 90s, 5m, 12h or 7d", text));
  }
  const std::chrono::milliseconds time(std::llround(*seconds * 1000));
  if (time >= least) return time;
  throw std::invalid_argument(
      fmt::format("\"{}\" is too short; give at least {}", text, from_time(least)));
}

std::string from_time(std::chrono::milliseconds time) {
  const auto whole = time.count() / 1000;
  const auto rest = time.count() % 1000;
  if (rest != 0) return fmt::format("{}.{:03}", whole, rest);
  for (const Unit& unit : time_units)
    if (unit.size > 1 && whole != 0 && whole % unit.size == 0)
      return fmt::format("{}{}", whole / unit.size, unit.name);
  return std::to_string(whole);
}

bool to_flag(const std::string& text) {
  if (text == "true") return true;
  if (text == "false") return false;
  throw std::invalid_argument(fmt::format("\"{}\" is neither true nor false", text));
}

}  // namespace anticrack::app
