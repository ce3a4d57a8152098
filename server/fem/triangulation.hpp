// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace anticrack::fem {

/// Triangles of one subdomain with its own node numbers, index base 0, counterclockwise.
struct Triangulation {
  std::vector<double> xy;               ///< (n,2) row-major
  std::vector<std::int32_t> triangles;  ///< (m,3) row-major

  /// The numbers n of nodes and m of triangles.
  std::size_t node_count() const noexcept { return xy.size() / 2; }
  std::size_t triangle_count() const noexcept { return triangles.size() / 3; }
};

}  // namespace anticrack::fem
