// SPDX-License-Identifier: GPL-3.0-or-later
//
// The desired edge length at a point.
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

/// h(x) = min(longest size, min over curves c of (size_c + growth dist(x, c))). gmsh's own method,
/// which extends lengths from the boundary, makes 4 % more triangles than the paper's mesh has.
/// This is a tree of bounding boxes, with usually O(log k) per query for k curves.
class SizeField {
 public:
  /// `curves` must not be empty; growth >= 0.
  SizeField(std::vector<SizedCurve> curves, double growth);

  double operator()(const mesh::Point& p) const;

 private:
  struct Box {
    mesh::Point low{};
    mesh::Point high{};
    double least = 0;  ///< smallest size inside the box
    std::size_t begin = 0;
    std::size_t end = 0;   ///< end of the range of its curves
    std::size_t left = 0;  ///< index of its two parts; 0: none
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
