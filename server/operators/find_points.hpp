// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where given points lie in a cut membrane.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fem/point_location.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::ddm {
struct Decomposition;
}

namespace anticrack::operators {

/// Distance, as a fraction of the diagonal of the membrane's bounding box, within which a point
/// lies on an edge or inside the membrane.
constexpr double point_tolerance = 1e-9;

struct PointPlace {
  /// An interface and its edge on which the point lies, of an inclusion rather than of a crack, of
  /// a crack rather than of glue, the nearest of these; -1: none.
  std::int32_t interface = -1, edge = -1;
  std::size_t subdomain = 0;  ///< in which it lies deepest
  fem::Location location;     ///< in that subdomain; triangle -1: outside the membrane
};

/// O(m log k + hits) for k points.
std::vector<PointPlace> find_points(std::span<const fem::PlanePoint> points, const mesh::Mesh& mesh,
                                    const ddm::Decomposition& decomposition);

}  // namespace anticrack::operators
