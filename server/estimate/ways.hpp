// SPDX-License-Identifier: GPL-3.0-or-later
//
// How far a unit of flux is from where it may leave the membrane: what brings a flux that is not
// quite in equilibrium there costs at most this in its norm.
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

/// The norm is that of 1/T. A unit flux that goes into a triangle through one side and out through
/// another is constant and has |e_i|^2 <= max |e|^2 there (Shapes::edge), and no less than one that
/// its divergence ends. In a chain of triangles the squares add up.
struct Ways {
  static constexpr double none = std::numeric_limits<double>::infinity();

  /// Of a unit through a side of any triangle, to the Dirichlet boundary or an inclusion that is
  /// held: the largest. `none` where contact alone holds a part of the membrane, and where an
  /// inclusion is held and tilts, or hangs on another.
  double triangle = none;

  /// Inclusions that share nodes. A unit force is taken off it through one of its sides, a moment
  /// by kappa curl(l_0 l_1) there, which has the moment kappa/6 along the side and no flux.
  struct Body {
    bool held = false;
    Vector from{};      ///< one of its nodes, about which moments are
    double extent = 0;  ///< to the farthest of its nodes
    double force = none;
    double moment = 0;            ///< 0: it does not tilt
    double slope = 0;             ///< what moves its nodes by at most 1 slopes by at most that
    std::optional<Vector> along;  ///< of a straight one that tilts: its direction

    /// The amount of a moment that turns it.
    double turning(const Vector& of) const {
      if (moment == 0) return 0;
      return along ? std::abs(dot(of, *along)) : std::hypot(of[0], of[1]);
    }
  };
  std::vector<Body> bodies;
  std::vector<std::int32_t> of;  ///< (inclusions) its body
};

/// `across`: (sides) side of the neighbour, negative where there is none. Breadth first, O(m).
Ways ways(const CutMesh& cut, std::span<const std::int32_t> across, const ddm::Skeleton& skeleton);

}  // namespace anticrack::estimate
