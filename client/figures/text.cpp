// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <utility>

#include "results/interval.hpp"
#include "words/shown.hpp"

namespace anticrack::figures {
namespace {

bool is_alphanumeric(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
}

std::string printed(double value, int digits) {
  if (!std::isfinite(value)) return "NaN";
  std::array<char, 40> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value + 0.0,
                                 std::chars_format::general, digits);
  return {buffer.data(), end.ptr};
}

std::string superscript(int exponent) {
  constexpr std::array<const char*, 10> digits{
      "\xE2\x81\xB0", "\xC2\xB9",     "\xC2\xB2",     "\xC2\xB3",     "\xE2\x81\xB4",
      "\xE2\x81\xB5", "\xE2\x81\xB6", "\xE2\x81\xB7", "\xE2\x81\xB8", "\xE2\x81\xB9"};
  std::string text;
  for (const char c : std::to_string(exponent))
    text += c == '-' ? "\xE2\x81\xBB" : digits[static_cast<std::size_t>(c - '0')];
  return text;
}

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

}  // namespace

std::size_t character(std::string_view text) {
  const words::Character first = words::first_character(text);
  return first.valid && !words::is_hidden(first.code) ? first.bytes : 0;
}

std::string quoted(std::string_view text, std::size_t limit) {
  std::string out = "'";
  std::size_t count = 0;
  while (!text.empty()) {
    if (++count > limit) {
      out += "\xE2\x80\xA6";
      break;
    }
    const std::size_t length = character(text);
    if (length == 0) {
      out += ' ';
      text.remove_prefix(1);
      continue;
    }
    if (text[0] == '\'') {
      // gnuplot does not see a doubled quote right after the one that opens the string.
      out += out.size() == 1 ? "\xE2\x80\x99" : "''";
    } else if (text[0] == '`') {
      out += "\xE2\x80\x98";  // the typographic quote
    } else if (text[0] == '\\') {
      out += "\xE2\x88\x96";  // gnuplot reads \n even where it should not
    } else {
      out += text.substr(0, length);
    }
    text.remove_prefix(length);
  }
  return out + "'";
}

std::size_t length(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u;  // all but the later bytes of UTF-8
  }));
}

std::string shortened(std::string_view text, std::size_t limit) {
  if (length(text) <= limit) return std::string(text);
  std::size_t end = text.size();
  while (length(text.substr(0, end)) >= limit) --end;
  return std::string(text.substr(0, end)) + "\xE2\x80\xA6";
}

std::string power_of_ten(int exponent) { return "10" + superscript(exponent); }

std::vector<std::string> wrapped(std::string_view text, std::size_t width, std::size_t most) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    std::size_t end = text.size();
    if (lines.size() + 1 < most && length(text) > width) {
      // The last blank that still fits, else the first.
      std::size_t blank = text.find(' ');
      end = blank;
      while (blank != std::string_view::npos && length(text.substr(0, blank)) <= width) {
        end = blank;
        blank = text.find(' ', blank + 1);
      }
      end = std::min(end, text.size());
    }
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::string number(double value, int digits) { return printed(value, digits); }

std::string bounded(double lower, double upper) {
  std::string text = results::interval(lower, upper);
  std::string power;
  if (const std::size_t e = text.find(")e"); e != std::string::npos) {
    power = "\xC3\x97" + power_of_ten(std::stoi(text.substr(e + 2)));
    text.resize(e + 1);
  }
  for (const auto& [plain, sign] : {std::pair{"+-", "\xC2\xB1"}, std::pair{"-", "\xE2\x88\x92"}})
    for (std::size_t at = 0; (at = text.find(plain, at)) != std::string::npos; at += 3)
      text.replace(at, std::string_view(plain).size(), sign);
  return text + power;
}

std::string readable(double value, int digits) {
  const std::string plain = printed(value, digits);
  const std::size_t e = plain.find('e');
  std::string text = plain.substr(0, e);
  if (text.starts_with('-')) text.replace(0, 1, "\xE2\x88\x92");
  if (e == std::string::npos) return text;
  const std::string power = power_of_ten(std::stoi(plain.substr(e + 1)));
  return text == "1" ? power : text + "\xC3\x97" + power;
}

std::vector<std::string> file_stems(const std::vector<std::string>& names,
                                    const std::vector<std::string>& suffixes) {
  std::set<std::string> taken;
  const auto files_of = [&](const std::string& stem) {
    std::vector<std::string> files{lower(stem)};
    for (const std::string& suffix : suffixes) files.push_back(lower(stem + suffix));
    return files;
  };
  std::vector<std::string> stems;
  for (const std::string& name : names) {
    std::string base;
    for (const char c : name) base += is_alphanumeric(c) || c == '.' || c == '-' ? c : '_';
    if (base.empty() || !is_alphanumeric(base[0])) base.insert(0, "load");
    std::string stem = base;
    for (int copy = 2;; ++copy) {
      const auto files = files_of(stem);
      if (std::none_of(files.begin(), files.end(),
                       [&](const std::string& file) { return taken.count(file) != 0; })) {
        taken.insert(files.begin(), files.end());
        break;
      }
      stem = base + "-" + std::to_string(copy);
    }
    stems.push_back(stem);
  }
  return stems;
}

}  // namespace anticrack::figures
