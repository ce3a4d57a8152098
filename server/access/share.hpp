// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace anticrack::access {

/// Whether a user who has `own` of something may have `wanted` more, of which `used` of `all` are
/// taken by everyone: a user may have as much as stays free (dynamic thresholds, Choudhury and
/// Hahne 1998). One user gets at most a half, two a third each, and a newcomer always finds room.
/// Who has nothing may have what is free.
constexpr bool may_have(std::uint64_t own, std::uint64_t wanted, std::uint64_t used,
                        std::uint64_t all) {
  if (used > all || wanted > all - used) return false;
  return own == 0 || own + wanted <= all - used - wanted;
}

}  // namespace anticrack::access
