// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which sides share one value, and the conditions that remain between the others.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ddm/decomposition.hpp"
#include "ddm/sides.hpp"

namespace anticrack::ddm {

/// Two sides of a node with an interface edge between them.
struct Couple {
  std::int32_t minus = 0;
  std::int32_t plus = 0;
  std::int32_t contact = -1;
};

struct Ties {
  std::vector<std::int32_t> unknown;  ///< (sides) entry of w
  std::vector<std::int32_t> rigid;    ///< (sides) inclusion it is the plus side of, or -1
  Skeleton skeleton;
  std::vector<Couple> couples;                      ///< in the order of the edges
  std::vector<std::array<std::int32_t, 2>> of_end;  ///< (edges) couple at each end, or -1
};

/// Throws errors::Error as `cut` does. O(k log k).
Ties tie(const mesh::Mesh& mesh, const Sides& sides);

}  // namespace anticrack::ddm
