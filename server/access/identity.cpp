// SPDX-License-Identifier: GPL-3.0-or-later
#include "access/identity.hpp"

#include "errors/errors.hpp"

namespace anticrack::access {

bool may_see(const Identity& who, const std::string& owner) noexcept {
  return who.role == Role::admin || who.name == owner;
}

void require_admin(const Identity& who, const std::string& action) {
  if (who.role == Role::admin) return;
  throw errors::Error(errors::Reason::permission_denied,
                      "only an administrator may {}; \"{}\" is a user", action, who.name);
}

}  // namespace anticrack::access
