// SPDX-License-Identifier: GPL-3.0-or-later
//
// Callers and their permissions: plain values and pure functions.
#pragma once

#include <string>

namespace anticrack::access {

enum class Role {
  user,   ///< sees and changes his own resources
  admin,  ///< sees and changes everything; may evict and pin
};

struct Identity {
  std::string name;  ///< empty if the server does not identify callers
  Role role = Role::user;

  friend bool operator==(const Identity&, const Identity&) = default;
};

/// Whether `who` may see a resource of `owner`. If not, it must look as if it did not exist
/// (not_found).
bool may_see(const Identity& who, const std::string& owner) noexcept;

/// Throws errors::Error (permission_denied) unless `who` is an administrator; `action` as in
/// "evict a mesh".
void require_admin(const Identity& who, const std::string& action);

}  // namespace anticrack::access
