// SPDX-License-Identifier: GPL-3.0-or-later
//
// Who asks, and what he may do: plain values and pure functions; knows no transport.
#pragma once

#include <string>

namespace anticrack::access {

enum class Role {
  user,   ///< sees and changes what he made
  admin,  ///< everything of everybody, and what touches everybody: evict, pin
};

struct Identity {
  std::string name;  ///< empty on a server that asks for none
  Role role = Role::user;

  friend bool operator==(const Identity&, const Identity&) = default;
};

/// A resource of `owner` is there for `who`. To anybody else it is as if it did not exist
/// (not_found), so that nobody learns of it by asking.
bool may_see(const Identity& who, const std::string& owner) noexcept;

/// Throws errors::Error (permission_denied) unless `who` is an administrator; `action` as in
/// "evict a mesh".
void require_admin(const Identity& who, const std::string& action);

}  // namespace anticrack::access
