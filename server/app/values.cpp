// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/values.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>

namespace anticrack::app {
namespace {

struct Unit {
  std::string_view name;
  std::uint64_t bytes;
};

constexpr std::array<Unit, 9> units{{{"", 1},
                                     {"K", 1000ULL},
                                     {"M", 1000ULL * 1000},
                                     {"G", 1000ULL * 1000 * 1000},
                                     {"T", 1000ULL * 1000 * 1000 * 1000},
                                     {"Ki", 1ULL << 10},
                                     {"Mi", 1ULL << 20},
                                     {"Gi", 1ULL << 30},
                                     {"Ti", 1ULL << 40}}};

struct TimeUnit {
  std::string_view name;
  std::int64_t seconds;
};

constexpr std::array<TimeUnit, 4> time_units{{{"d", 86'400}, {"h", 3'600}, {"m", 60}, {"s", 1}}};

/// Reads a number that is not negative from the start of `text` and returns what comes after it,
/// blanks removed; false where there is none.
bool split_number(std::string_view text, double& number, std::string_view& rest) {
  const char* end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, number);
  if (problem != std::errc() || !std::isfinite(number) || std::signbit(number)) return false;
  rest = text.substr(static_cast<std::size_t>(stop - text.data()));
  while (rest.starts_with(' ')) rest.remove_prefix(1);
  return true;
}

}  // namespace

std::uint64_t to_bytes(const std::string& text) {
  double number = 0;
  std::string_view rest;
  if (split_number(text, number, rest)) {
    if (rest.size() > 1 && rest.ends_with('B')) rest.remove_suffix(1);
    if (rest == "B") rest = "";
    for (const Unit& unit : units) {
      const double bytes = number * static_cast<double>(unit.bytes);
      if (rest == unit.name && bytes < std::ldexp(1.0, 63)) {
        return static_cast<std::uint64_t>(std::llround(bytes));
      }
    }
  }
  throw std::invalid_argument("\"" + text + "\" is not a number of bytes; write e.g. 2GiB or 500M");
}

std::string from_bytes(std::uint64_t bytes) {
  for (std::size_t i = units.size(); i-- > 5;) {
    if (bytes != 0 && bytes % units[i].bytes == 0) {
      return std::to_string(bytes / units[i].bytes) + std::string(units[i].name) + "B";
    }
  }
  return std::to_string(bytes);
}

std::int64_t to_integer(const std::string& text, std::int64_t least, std::int64_t most) {
  std::int64_t value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, value);
  if (problem != std::errc() || stop != end || value < least || value > most) {
    throw std::invalid_argument("\"" + text + "\" is not an integer between " +
                                std::to_string(least) + " and " + std::to_string(most));
  }
  return value;
}

std::chrono::milliseconds to_time(const std::string& text) {
  constexpr double longest = 30 * 86'400.0;
  double number = 0;
  std::string_view rest;
  if (split_number(text, number, rest)) {
    if (rest.empty()) rest = "s";
    for (const TimeUnit& unit : time_units) {
      const double seconds = number * static_cast<double>(unit.seconds);
      if (rest == unit.name && seconds <= longest) {
        return std::chrono::milliseconds(std::llround(seconds * 1000));
      }
    }
  }
  throw std::invalid_argument(
      "\"" + text + "\" is not a time of at most 30 days; write e.g. 0.5, 90s, 5m, 12h or 7d");
}

std::string from_time(std::chrono::milliseconds time) {
  const auto whole = time.count() / 1000;
  const auto rest = time.count() % 1000;
  if (rest != 0) return std::to_string(whole) + "." + std::to_string(1000 + rest).substr(1);
  for (const TimeUnit& unit : time_units) {
    if (unit.seconds > 1 && whole != 0 && whole % unit.seconds == 0) {
      return std::to_string(whole / unit.seconds) + std::string(unit.name);
    }
  }
  return std::to_string(whole);
}

bool to_flag(const std::string& text) {
  if (text == "true") return true;
  if (text == "false") return false;
  throw std::invalid_argument("\"" + text + "\" is neither true nor false");
}

}  // namespace anticrack::app
