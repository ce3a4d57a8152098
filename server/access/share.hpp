// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace anticrack::access {

/// The most that a user who has `own` of something may have now, if everyone together has `used` of
/// `all`: as much as stays free (dynamic thresholds, Choudhury and Hahne 1998). One user gets at
/// most a half, two a third each, and a newcomer always finds room.
constexpr std::uint64_t share(std::uint64_t own, std::uint64_t used, std::uint64_t all) {
  const std::uint64_t others = used - own;
  return others < all ? (all - others) / 2 : 0;
}

/// Whether this user may have `wanted` more. A user who has nothing may have all that is free.
constexpr bool may_have(std::uint64_t own, std::uint64_t wanted, std::uint64_t used,
                        std::uint64_t all) {
  if (used > all || wanted > all - used) return false;
  return own == 0 || own + wanted <= share(own, used, all);
}

}  // namespace anticrack::access
