// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/text.hpp"

#include <fmt/core.h>
#include <unistr.h>
#include <uniwidth.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <ctime>

#include "words/shown.hpp"

namespace anticrack::cli {
namespace {

struct Character {
  std::size_t length;  // in bytes
  std::size_t columns;
};

Character first_character(std::string_view text) {
  ucs4_t point = 0;
  const int length =
      u8_mbtoucr(&point, reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  const int columns = length < 0 ? 1 : uc_width(point, "UTF-8");
  return {length < 0 ? 1 : static_cast<std::size_t>(length),
          columns < 0 ? 1 : static_cast<std::size_t>(columns)};
}

}  // namespace

std::string sanitise(std::string_view text) { return words::shown(text); }

std::size_t columns_of(std::string_view text) noexcept {
  std::size_t columns = 0;
  while (!text.empty()) {
    const Character character = first_character(text);
    columns += character.columns;
    text.remove_prefix(character.length);
  }
  return columns;
}

std::string fit(std::string_view text, std::size_t width) {
  if (columns_of(text) <= width) return std::string(text);
  if (width == 0) return "";
  std::size_t end = 0;
  for (std::size_t columns = 0;;) {
    const Character character = first_character(text.substr(end));
    columns += character.columns;
    if (columns >= width) return std::string(text.substr(0, end)) + "~";
    end += character.length;
  }
}

std::string pad_right(std::string_view text, std::size_t width) {
  const std::size_t columns = columns_of(text);
  return std::string(text) + std::string(width > columns ? width - columns : 0, ' ');
}

std::string pad_left(std::string_view text, std::size_t width) {
  const std::size_t columns = columns_of(text);
  return std::string(width > columns ? width - columns : 0, ' ') + std::string(text);
}

std::string number(double value, int digits, bool exponent) {
  if (!std::isfinite(value)) return "-";
  value += 0.0;  // no "-0"
  return exponent ? fmt::format("{:.{}e}", value, digits) : fmt::format("{:.{}g}", value, digits);
}

std::string exact(double value) {
  if (!std::isfinite(value)) return "";
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value + 0.0);
  return {buffer.data(), result.ptr};
}

std::string per_cent(double value) { return number(100 * value, value < 1 ? 2 : 3) + " %"; }

std::string contact_text(double length) {
  const std::string three = number(length, 3);
  return three == "-" ? three : number(std::strtod(three.c_str(), nullptr));  // 1230, not 1.23e+03
}

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char each : text) quoted += each == '"' ? std::string("\"\"") : std::string(1, each);
  return quoted + "\"";
}

std::string seconds(double value) {
  constexpr double a_second = 1e4;
  return number(std::round(value * a_second) / a_second, 3);
}

std::string bytes(std::uint64_t count) {
  const std::array<const char*, 5> units{" B", " kB", " MB", " GB", " TB"};
  auto value = static_cast<double>(count);
  std::size_t unit = 0;
  while (value >= 999.5 && unit + 1 < units.size()) {
    value /= 1000;
    ++unit;
  }
  return number(value, 3) + units[unit];
}

std::string time_text(double seconds) {
  if (!(seconds >= 0) || seconds >= 1e9) return "-";
  if (seconds < 9.5) return number(seconds, 2) + " s";
  const auto whole = static_cast<std::int64_t>(std::lround(seconds));
  constexpr std::int64_t minute = 60;
  constexpr std::int64_t hour = 60 * minute;
  if (whole < minute) return fmt::format("{} s", whole);
  if (whole < hour) return fmt::format("{} min {} s", whole / minute, whole % minute);
  return fmt::format("{} h {} min", whole / hour, whole % hour / minute);
}

std::string clock_text(std::int64_t seconds) {
  const auto time = static_cast<std::time_t>(seconds);
  std::tm local{};
  std::array<char, 64> buffer{};
  if (localtime_r(&time, &local) == nullptr) return "-";  // the year does not fit
  return {buffer.data(), std::strftime(buffer.data(), buffer.size(), "%Y-%m-%d %H:%M:%S", &local)};
}

std::string table(std::vector<std::vector<std::string>> rows,
                  const std::vector<std::size_t>& left) {
  std::vector<std::size_t> widths;
  for (auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t j = 0; j < row.size(); ++j) {
      row[j] = sanitise(row[j]);
      widths[j] = std::max(widths[j], columns_of(row[j]));
    }
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t j = 0; j < row.size(); ++j) {
      const bool to_left = j == 0 || std::find(left.begin(), left.end(), j) != left.end();
      line += (j == 0 ? "" : "  ");
      line += to_left ? pad_right(row[j], widths[j]) : pad_left(row[j], widths[j]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string short_table(std::vector<std::vector<std::string>> rows,
                        const std::vector<std::size_t>& left) {
  constexpr std::size_t most = 11;  // rows, including the head
  if (rows.size() <= most + 1) return table(rows, left);
  const std::size_t others = rows.size() - most;
  rows.resize(most);
  return fmt::format("{}and {} more, see --json\n", table(rows, left), others);
}

std::string counted(std::size_t count, const std::string& one) {
  return fmt::format("{} {}{}", count, one, count == 1 ? "" : "s");
}

void drop_if_empty(std::vector<std::vector<std::string>>& rows, std::size_t column) {
  const auto empty = [&](const auto& row) { return row.at(column).empty(); };
  if (!std::all_of(rows.begin() + 1, rows.end(), empty)) return;
  for (auto& row : rows) row.erase(row.begin() + static_cast<std::ptrdiff_t>(column));
}

}  // namespace anticrack::cli
