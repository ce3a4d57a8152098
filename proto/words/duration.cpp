// SPDX-License-Identifier: GPL-3.0-or-later
#include "words/duration.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

namespace anticrack::words {
namespace {

struct Unit {
  std::string_view name;
  double milliseconds;
};

constexpr std::array<Unit, 6> units{
    {{"", 1e3}, {"s", 1e3}, {"ms", 1}, {"min", 60e3}, {"h", 3'600e3}, {"d", 86'400e3}}};
constexpr double longest_time = 366 * 86'400e3;

}  // namespace

std::optional<std::chrono::milliseconds> parse_duration(std::string_view text) {
  double number = 0;
  const char* end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, number);
  if (problem != std::errc()) return std::nullopt;
  std::string_view rest(stop, static_cast<std::size_t>(end - stop));
  while (rest.starts_with(' ')) rest.remove_prefix(1);
  const auto* unit = std::ranges::find(units, rest, &Unit::name);
  if (unit == units.end()) return std::nullopt;
  const double time = std::round(number * unit->milliseconds);
  if (!(time >= 1 && time <= longest_time)) return std::nullopt;  // NaN as well
  return std::chrono::milliseconds(static_cast<std::int64_t>(time));
}

}  // namespace anticrack::words
