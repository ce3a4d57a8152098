// SPDX-License-Identifier: GPL-3.0-or-later
//
// The deformed membrane as triangles, coarsened to what a picture can show.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "results/result.hpp"

namespace anticrack::figures {

struct Vertex {
  double x = 0;
  double y = 0;
  double u = 0;
  /// Mean over the triangles at the vertex on its face of the interfaces, by area: grad u, and
  /// |T grad u|; where some T is a law, of which a result has the mean alone, |grad u|.
  double slope_x = 0;
  double slope_y = 0;
  double flux = 0;
};

using Triangle = std::array<Vertex, 3>;

struct Surface {
  std::vector<Triangle> triangles;
  double lowest = 0;  ///< u over all vertices, zero included
  double highest = 0;
  /// |T grad u| (or |grad u|) of every triangle of the mesh, merged or not, and twice its area.
  std::vector<std::pair<double, double>> fluxes;
  double x_min = 0, x_max = 0, y_min = 0, y_max = 0;  ///< of the mesh

  double largest() const noexcept;  ///< |u|
  double width() const noexcept;    ///< longer side of the bounding box
};

/// Triangles with the u of their own face, so cracks are open; without values that are not finite.
/// To stay within `limit`, neighbours in one cell of a grid are merged, interface, boundary and
/// interior separately. Needs load.fields. O(m log m).
Surface surface(const results::Result& result, const results::Load& load, std::size_t limit);

/// The same surface with triangles of at most `longest` edges, each split into four as often as it
/// takes, as long as there are at most `limit`.
std::vector<Triangle> refined(std::vector<Triangle> triangles, double longest, std::size_t limit);

/// A round factor that scales u to at most three tenths of the mean of the membrane's sides; 1 for
/// u = 0.
double amplification(const Surface& surface);

}  // namespace anticrack::figures
