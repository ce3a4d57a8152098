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

/// Bearer tokens by their SHA-256, so that the file they come from holds no secret that opens
/// anything. One a line: NAME ROLE SHA256, ROLE user or admin, # comments. NAME is
/// [A-Za-z0-9][A-Za-z0-9_.@-]{0,63}.
class TokenTable {
 public:
  TokenTable() = default;
  /// Throws errors::Error (invalid_argument) with the line's number: what cannot be read, a name
  /// with two roles, a hash twice. `origin` names the file in errors.
  static TokenTable parse(std::string_view text, const std::string& origin);

  /// Whose token this is. Compares with every entry in constant time.
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
