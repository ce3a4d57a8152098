// SPDX-License-Identifier: GPL-3.0-or-later
//
// How far a unit of flux is from a place where it may leave the membrane: to lead the unbalanced
// part of a flux out costs at most this much in the norm of the flux.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "ddm/decomposition.hpp"
#include "estimate/shapes.hpp"

namespace anticrack::estimate {

struct CutMesh;

/// The norm is that of 1/T. A unit flux that enters a triangle through one side and leaves it
/// through another is constant and has the square |e_i|^2 <= max |e|^2 there (Shapes::edge); one
/// that ends in the triangle by its divergence has no more. In a chain of triangles the squares add
/// up.
struct Ways {
  static constexpr double none = std::numeric_limits<double>::infinity();

  /// The largest norm, over all triangles, of leading a unit from a side of the triangle to the
  /// Dirichlet boundary or to an inclusion that is held. `none` if contact alone holds a part of
  /// the membrane, if an inclusion is held and tilts, or if it depends on another.
  double triangle = none;

  /// Inclusions that share nodes. A unit force leaves the body through one of its sides, a moment
  /// by kappa curl(l_0 l_1) there, which has the moment kappa/6 along the side and no flux.
  struct Body {
    bool held = false;
    Vector from{};      ///< one of its nodes, the reference point of moments
    double extent = 0;  ///< distance from there to its farthest node
    double force = none;
    double moment = 0;            ///< 0: it does not tilt
    double slope = 0;             ///< its largest slope if no node moves by more than 1
    std::optional<Vector> along;  ///< its direction, if it is straight and tilts

    /// The part of a moment that can turn the body.
    double turning(const Vector& of) const {
      if (moment == 0) return 0;
      return along ? std::abs(dot(of, *along)) : std::hypot(of[0], of[1]);
    }
  };
  std::vector<Body> bodies;
  std::vector<std::int32_t> of;  ///< (inclusions) index of its body
};

/// `across`: (sides) side of the neighbour, negative if there is none. Breadth-first search, O(m).
Ways ways(const CutMesh& cut, std::span<const std::int32_t> across, const ddm::Skeleton& skeleton);

}  // namespace anticrack::estimate
