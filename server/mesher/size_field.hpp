// SPDX-License-Identifier: GPL-3.0-or-later
//
// The desired edge length at a point.
#pragma once

#include <vector>

#include "mesh/box_tree.hpp"
#include "mesh/geometry.hpp"

namespace anticrack::mesher {

/// A straight curve and the length of its intervals.
struct SizedCurve {
  mesh::Point a{};
  mesh::Point b{};
  double size = 0;
};

/// h(x) = min(longest size, min over curves c of (size_c + growth dist(x, c))). gmsh's own method,
/// which extends lengths from the boundary, makes 4 % more triangles than the paper's mesh has.
/// This is a tree of bounding boxes, with usually O(log k) per query for k curves.
class SizeField {
 public:
  /// `curves` must not be empty; growth >= 0.
  SizeField(std::vector<SizedCurve> curves, double growth);

  double operator()(const mesh::Point& p) const;

 private:
  double bound(const mesh::Box& box, const mesh::Point& p) const;
  void search(std::size_t box, const mesh::Point& p, double& best) const;

  std::vector<SizedCurve> _curves;
  double _growth;
  double _longest = 0;
  std::vector<mesh::Box> _boxes;  ///< value: the smallest size
};

}  // namespace anticrack::mesher
