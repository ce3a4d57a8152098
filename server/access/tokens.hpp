// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "access/identity.hpp"

namespace anticrack::access {

/// Bearer tokens, known by their SHA-256 only, so that their file contains no secrets. Lines: NAME
/// ROLE SHA256; ROLE is user or admin, # begins a comment, NAME is
/// [A-Za-z0-9][A-Za-z0-9_.@-]{0,63}.
class TokenTable {
 public:
  TokenTable() = default;
  /// `origin` is the file's name for errors. Throws errors::Error (invalid_argument) with the
  /// line's number: a bad line, a name with two roles, a repeated hash.
  static TokenTable parse(std::string_view text, const std::string& origin);

  /// The owner of a token, if any. Compares with every entry in constant time.
  std::optional<Identity> find(std::string_view token) const;
  bool empty() const noexcept { return _entries.empty(); }

 private:
  struct Entry {
    std::array<std::uint8_t, 32> hash;
    Identity identity;
  };
  std::vector<Entry> _entries;
};

}  // namespace anticrack::access
