// SPDX-License-Identifier: GPL-3.0-or-later
//
// The deformed membrane as a soup of triangles, coarsened to what a picture can show.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "results/result.hpp"

namespace anticrack::figures {

struct Vertex {
  double x = 0;
  double y = 0;
  double u = 0;
};

using Triangle = std::array<Vertex, 3>;

struct Surface {
  std::vector<Triangle> triangles;
  double lowest = 0;  ///< u over all vertices, zero included
  double highest = 0;
  double x_min = 0, x_max = 0, y_min = 0, y_max = 0;  ///< of the mesh

  double largest() const noexcept;  ///< |u|
  double width() const noexcept;    ///< longer side of the bounding box
};

/// Every triangle with the u of its own face, so that the faces of a crack come apart; triangles
/// with a value that is not finite are left out. More than `limit` triangles are merged: neighbours
/// in one cell of a grid become one, interface, boundary and interior apart from each other.
/// Needs load.fields. O(m log m).
Surface surface(const results::Result& result, const results::Load& load, std::size_t limit);

/// A round factor that makes u range over about a third of the membrane's width; 1 for u = 0.
double amplification(const Surface& surface);

}  // namespace anticrack::figures
