// SPDX-License-Identifier: GPL-3.0-or-later
//
// The edge length wanted at a point.
#pragma once

#include <vector>

#include "mesh/geometry.hpp"

namespace anticrack::mesher {

/// A straight curve and the length of its intervals.
struct SizedCurve {
  mesh::Point a{};
  mesh::Point b{};
  double size = 0;
};

/// h(x) = min(longest size, min over curves (size_c + growth dist(x, c))): graded away from curves
/// that are cut finer. gmsh's own way, to carry the lengths inwards from the boundary, makes 4 %
/// more triangles than the paper's mesh has.
/// A tree of bounding boxes: O(log k) a query, as a rule, in the k curves.
class SizeField {
 public:
  /// At least one curve; growth >= 0.
  SizeField(std::vector<SizedCurve> curves, double growth);

  double operator()(const mesh::Point& p) const;

 private:
  struct Box {
    mesh::Point low{};
    mesh::Point high{};
    double least = 0;  ///< smallest size inside
    std::size_t begin = 0;
    std::size_t end = 0;   ///< of its curves
    std::size_t left = 0;  ///< its parts, 0 for none: the root is not a part
    std::size_t right = 0;
  };

  std::size_t build(std::size_t begin, std::size_t end);
  double bound(const Box& box, const mesh::Point& p) const;
  void search(std::size_t box, const mesh::Point& p, double& best) const;

  std::vector<SizedCurve> _curves;
  double _growth;
  double _longest = 0;
  std::vector<Box> _boxes;
};

}  // namespace anticrack::mesher
