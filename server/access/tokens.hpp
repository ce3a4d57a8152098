// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "access/identity.hpp"

namespace anticrack::access {

/// Bearer tokens, known by their SHA-256 only, so that their file contains no secrets. Lines: NAME
/// ROLE SHA256 [LAST-DAY]; ROLE is user or admin, # begins a comment, NAME is
/// [A-Za-z0-9][A-Za-z0-9_.@-]{0,63}. LAST-DAY is YYYY-MM-DD: the token is valid until the end of
/// that day in UTC; without it the token does not expire.
class TokenTable {
 public:
  TokenTable() = default;
  /// `origin` is the file's name for errors. Throws errors::Error (invalid_argument) with the
  /// line's number: a bad line, a name with two roles, a repeated hash.
  static TokenTable parse(std::string_view text, const std::string& origin);

  /// The owner of a token, if any. Compares with every entry in constant time. Throws errors::Error
  /// (unauthenticated) if the token has expired.
  std::optional<Identity> find(std::string_view token, std::chrono::system_clock::time_point now =
                                                           std::chrono::system_clock::now()) const;
  bool empty() const noexcept { return _entries.empty(); }

 private:
  struct Entry {
    std::array<std::uint8_t, 32> hash;
    Identity identity;
    std::optional<std::chrono::year_month_day> last_day;  ///< none: valid for ever
  };
  std::vector<Entry> _entries;
};

}  // namespace anticrack::access
