// SPDX-License-Identifier: GPL-3.0-or-later
#include "access/tokens.hpp"

#include <fmt/core.h>
#include <openssl/crypto.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <iterator>
#include <map>
#include <span>
#include <sstream>
#include <utility>

#include "digest/digest.hpp"
#include "errors/errors.hpp"

namespace anticrack::access {
namespace {

using Hash = std::array<std::uint8_t, 32>;

constexpr std::size_t max_name_bytes = 64;

errors::Error bad_line(const std::string& origin, std::size_t line, const std::string& what) {
  return errors::Error(errors::Reason::invalid_argument, "{}, line {}: {}", origin, line, what)
      .at("tokens");
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line);
  return {std::istream_iterator<std::string>(stream), {}};
}

bool is_alphanumeric(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

bool is_name(std::string_view text) {
  return !text.empty() && text.size() <= max_name_bytes && is_alphanumeric(text.front()) &&
         std::all_of(text.begin(), text.end(), [](char c) {
           return is_alphanumeric(c) || c == '_' || c == '.' || c == '@' || c == '-';
         });
}

std::optional<Role> to_role(std::string_view text) {
  if (text == "user") return Role::user;
  if (text == "admin") return Role::admin;
  return std::nullopt;
}

std::optional<Hash> to_hash(std::string_view text) {
  constexpr std::string_view digits = "0123456789abcdef";
  Hash hash{};
  if (text.size() != 2 * hash.size()) return std::nullopt;
  if (text.find_first_not_of(digits) != std::string_view::npos) return std::nullopt;
  for (std::size_t i = 0; i < hash.size(); ++i) {
    hash[i] =
        static_cast<std::uint8_t>(16 * digits.find(text[2 * i]) + digits.find(text[2 * i + 1]));
  }
  return hash;
}

template <class Part>
bool read_digits(std::string_view text, Part& part) {
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), part);
  return code == std::errc() && end == text.data() + text.size();
}

/// A day from a text YYYY-MM-DD.
std::optional<std::chrono::year_month_day> to_day(std::string_view text) {
  unsigned year = 0;
  unsigned month = 0;
  unsigned day = 0;
  if (text.size() != 10 || text[4] != '-' || text[7] != '-' ||
      !read_digits(text.substr(0, 4), year) || !read_digits(text.substr(5, 2), month) ||
      !read_digits(text.substr(8), day))
    return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(static_cast<int>(year)),
                                         std::chrono::month(month), std::chrono::day(day)};
  if (!date.ok()) return std::nullopt;
  return date;
}

std::string text_of(const std::chrono::year_month_day& date) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%04d-%02u-%02u", static_cast<int>(date.year()),
                static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
  return text.data();
}

}  // namespace

TokenTable TokenTable::parse(std::string_view text, const std::string& origin) {
  TokenTable table;
  std::map<std::string, Role, std::less<>> roles;
  std::istringstream lines{std::string(text)};
  std::string line;
  for (std::size_t number = 1; std::getline(lines, line); ++number) {
    const std::vector<std::string> words = words_of(line.substr(0, line.find('#')));
    if (words.empty()) continue;
    // The line may contain a token by mistake: errors never repeat it.
    if (words.size() != 3 && words.size() != 4) {
      throw bad_line(origin, number,
                     fmt::format("{} words; write NAME ROLE SHA256 or NAME ROLE SHA256 YYYY-MM-DD",
                                 words.size()));
    }
    if (!is_name(words[0])) {
      throw bad_line(origin, number,
                     "a name is at most 64 letters, digits and _.@-, beginning with a letter or "
                     "digit");
    }
    const std::optional<Role> role = to_role(words[1]);
    if (!role) throw bad_line(origin, number, "the role must be user or admin");
    const std::optional<Hash> hash = to_hash(words[2]);
    if (!hash) {
      throw bad_line(origin, number,
                     "the third word must be the token's SHA-256 in 64 lower-case hexadecimal "
                     "digits: printf %s TOKEN | sha256sum");
    }
    std::optional<std::chrono::year_month_day> last_day;
    if (words.size() == 4) {
      last_day = to_day(words[3]);
      if (!last_day) {
        throw bad_line(
            origin, number,
            "the fourth word must be the token's last day, YYYY-MM-DD (UTC), or missing");
      }
    }
    const auto [known, fresh] = roles.emplace(words[0], *role);
    if (!fresh && known->second != *role) {
      throw bad_line(origin, number,
                     "\"" + known->first + "\" has another role on an earlier line");
    }
    for (const Entry& entry : table._entries) {
      if (entry.hash == *hash) {
        throw bad_line(origin, number,
                       "the same token is on an earlier line, for \"" + entry.identity.name + "\"");
      }
    }
    table._entries.push_back({*hash, {known->first, *role}, last_day});
  }
  return table;
}

std::optional<Identity> TokenTable::find(std::string_view token,
                                         std::chrono::system_clock::time_point now) const {
  digest::Sha256 digest;
  digest.add(std::as_bytes(std::span(token)));
  const std::optional<Hash> hash = to_hash(digest.finish());
  const Entry* found = nullptr;
  for (const Entry& entry : _entries)  // all of them: the time reveals nothing
    if (CRYPTO_memcmp(entry.hash.data(), hash->data(), hash->size()) == 0) found = &entry;
  if (found == nullptr) return std::nullopt;
  if (found->last_day &&
      std::chrono::floor<std::chrono::days>(now) > std::chrono::sys_days(*found->last_day)) {
    throw errors::Error(
        errors::Reason::unauthenticated,
        "the token expired at the end of {} (UTC); ask the server's administrator for a new one",
        text_of(*found->last_day));
  }
  return found->identity;
}

}  // namespace anticrack::access
