// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace anticrack::access {

/// Most that a user may have now who has `own` of something, of which everyone together has `used`
/// of `all`: as much as stays free (dynamic thresholds, Choudhury and Hahne 1998). One user gets at
/// most a half, two a third each, and a newcomer always finds room.
constexpr std::uint64_t share(std::uint64_t own, std::uint64_t used, std::uint64_t all) {
  const std::uint64_t others = used - own;
  return others < all ? (all - others) / 2 : 0;
}

/// Whether this user may have `wanted` more. Who has nothing may have what is free.
constexpr bool may_have(std::uint64_t own, std::uint64_t wanted, std::uint64_t used,
                        std::uint64_t all) {
  if (used > all || wanted > all - used) return false;
  return own == 0 || own + wanted <= share(own, used, all);
}

}  // namespace anticrack::access
