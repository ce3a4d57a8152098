// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bounds of A from a pair that belongs to the mesh and holds for every load: z, the answer to a
// unit force with every contact closed, and tau, the flux of z', the answer with every contact
// open. As [z] = 0 and tau passes nothing through contacts, both cones of interval.hpp hold with
// c = 0. With D = (grad v - sigma / T) / 2, rho^2 = |D|^2 + int p [v] and m of bracket.hpp's proof,
//
//   A(u) = A(v) + int (tau - T grad z) . m - int tau . D,   |m| <= rho,
//   int tau . D = int (tau - T grad z') . D - 1/4 sum (w_0 - w_1) ([z']_0 - [z']_1),
//   |tau - T grad z|^2 = |tau - T grad z'|^2 + A(z') - A(z),
//
// the sum over minus faces, w the flux of sigma through their ends. So one solve and one flux bound
// A for all loads, and a load costs nothing but the sums of PrimalNorms.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "estimate/bracket.hpp"
#include "estimate/interval.hpp"
#include "estimate/lack.hpp"

namespace anticrack::estimate {

/// Norms of a pair; those of fluxes in the norm of 1/T.
struct MeshDual {
  double norm = std::numeric_limits<double>::infinity();  ///< >= |tau|; not finite: none is known
  double off = 0;                                         ///< >= |tau - T grad z|
  double mismatch = 0;                                    ///< >= |tau - T grad z'|
  double closed = 0;                                      ///< |z|
  double open = 0;                                        ///< |z'|
  double largest = 0;                                     ///< max |z'|
  double change = 0;  ///< root of the sum of ([z']_0 - [z']_1)^2
};

/// What of an answer the bounds need.
struct PrimalNorms {
  double distance = 0;  ///< Bracket::distance
  double work = 0;      ///< Bracket::work
  double rest = 0;      ///< of the load that is not balanced: root of the sum of o_K^2
  double lift = 0;      ///< |w|
  double unknown = 0;   ///< of T, times |u_h|
  double residual = 0;  ///< Lack::work
  double way = 0;       ///< Ways::triangle
  double change = 0;    ///< root of the sum of (w_0 - w_1)^2
  double pulling = 0;   ///< sum of what w_0 + w_1 are above 0
};

/// A pair for each z', empty where there is none. `closed`: A(z) of each, the displacement under
/// the unit force with every contact closed; `units`: Dual::unit of each. The bits of each are as
/// if it were alone. O(m) each.
std::vector<MeshDual> mesh_duals(const CutMesh& cut, std::span<const std::vector<double>> open,
                                 std::span<const double> closed,
                                 std::span<const std::vector<ForceOn>> units);

/// O(m).
PrimalNorms primal_norms(const Primal& primal, const Bracket& bracket);

/// |A(u) - A(u_h)| at most. O(1).
double half_width(const MeshDual& dual, const PrimalNorms& of);

}  // namespace anticrack::estimate
