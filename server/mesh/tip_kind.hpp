// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace anticrack::mesh {

/// The kind of a tip. The numbers are those of the API's TipKind.
enum class TipKind : std::int32_t {
  delaminated_end = 1,  ///< end of a delaminated inclusion: one face held, the other free
  front,                ///< bonded ahead, delaminated behind
  crack_tip,
  bonded_end,  ///< end of a bonded inclusion
  other,       ///< where several lines or conditions meet
};

}  // namespace anticrack::mesh
