// SPDX-License-Identifier: GPL-3.0-or-later
//
// Weights for the bounds of A (interval.hpp) that grow towards the ends of contact zones.
//
// At such an end x_0 the adjoint has [z] ~ s^1/2 where [u] ~ s^3/2, s the distance from it, and no
// constant c holds [z] <= c [u]. But what the error can do there is small, by an argument of
// Saint-Venant's kind. Let x_0 lie on the minus side of a delaminated inclusion that does not tilt,
// straight within R of x_0, and let the half disc of radius R on that side meet no other face, and
// T be one number in it. On one side of x_0 let contact be closed, [v] = 0 and p > 0, for l < s <
// R. For
//
//   w = (R / max(s, l))^beta within R on the minus side, w = 1 elsewhere;   b = s |w'|,
//   P(s) = int p over the face within s of x_0,   k = w - |w'| P / p on the closed side for
//   l < s < R, k = w elsewhere,   D = (grad v - sigma / T) / 2,   m = grad u - grad v + D:
//
//   int w T |m|^2 + int w (p_u [v] + p [u]) <= int w T |D|^2 + int w p [v]
//                       + int b T (|m| + |D|)^2 + int (w - k) p [u],   p_u the pressure of u.
//
// So [z] <= c w [v] and -q <= c k p hold A as well as a cone of constant c does (THEORY.md). Discs
// of several ends are disjoint, and their weights add up.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "estimate/equilibrated_flux.hpp"

namespace anticrack::estimate {

/// The end of a contact zone, in a node of the minus side of a delaminated inclusion.
struct ContactEnd {
  std::size_t face = 0;    ///< the minus face beside it that is open
  std::int32_t open = -1;  ///< the copy at the far end of that face
  double length = 0;       ///< of the face
  Vector place{};          ///< x_0
  Vector along{};          ///< unit vector from x_0 into the closed zone
  Vector normal{};         ///< unit vector from the minus to the plus side
  double reach = 0;        ///< R; the closed zone has a node at this distance
};

/// The ends about which a weight is possible. None if T varies on triangles, or if there are more
/// than a few ends. In a disc the root of the sum of squares of `oscillation` (LoadBalance; empty:
/// 0) is at most `most_unbalanced`. O(m log m + faces).
std::vector<ContactEnd> contact_ends(const CutMesh& cut, const EquilibratedFlux& sigma,
                                     std::span<const double> oscillation, double most_unbalanced);

struct Weight {
  struct OnTriangle {
    std::size_t triangle;
    double most, least;  ///< of w
    bool sloped;         ///< whether b > 0 in a part of it
  };
  /// On a minus face. `bound`: the least of k p at ends 0 and 1; its sum holds along the face.
  struct OnFace {
    std::size_t face;
    double most, least;
    double bound[2];
  };
  double beta = 0;
  std::vector<OnTriangle> triangles;  ///< where w > 1 somewhere, in ascending order
  std::vector<OnFace> faces;          ///< likewise
  double largest = 1;                 ///< of w
};

/// The values of a weight, or without one 1 and the pressure of sigma.
class WeightOf {
 public:
  WeightOf(const EquilibratedFlux& sigma, const Weight* weight);
  /// On a minus face; faces must be asked for in ascending order.
  Weight::OnFace on(std::size_t face);

 private:
  const EquilibratedFlux& _sigma;
  std::span<const Weight::OnFace> _faces;
};

/// The weight with l about `inner` times R, and at least three faces, at each of the ends. An end
/// where k < 0 on a face, or whose l is not below R / 2, gets none; without any end the weight is
/// empty. O(m).
Weight weight_about(const CutMesh& cut, const EquilibratedFlux& sigma,
                    const std::vector<ContactEnd>& ends, double inner, double beta);

}  // namespace anticrack::estimate
