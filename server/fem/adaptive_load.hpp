// SPDX-License-Identifier: GPL-3.0-or-later
//
// The load vector of an expression.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "expression/function.hpp"
#include "fem/load_proof.hpp"

namespace anticrack::fem {

struct IntegrationLimits {
  double relative_tolerance = 1e-10;  ///< relative to int |f|
  /// Limit of the work after the first samples, roughly in ns. It is counted in operations, not
  /// measured, so that results are reproducible.
  double work = 1e9;
  /// Limit of the work of the first samples, roughly in ns. An expression that takes longer is
  /// interpolated linearly between the nodes, and some of the triangles give an estimate of the
  /// error.
  double first_work = 1e12;
  double proof_tolerance = 1e-6;  ///< for the unknown part (ProofOptions)
  double proof_work = 1e9;        ///< limit of the work of the proof, roughly in ns
};

/// Tolerance of the unknown part of a force, relative to int |f|: small beside the error of linear
/// elements, which is about 1 / sqrt(triangles).
inline double proof_tolerance(std::size_t triangles) {
  return 3e-2 / std::sqrt(static_cast<double>(triangles) + 1);
}

/// Limits with which integrating never takes more than a few times as long as solving, some 40 ns a
/// triangle.
inline IntegrationLimits limits_of(double tolerance, std::size_t triangles) {
  const auto count = static_cast<double>(triangles);
  return {tolerance, 8e6 + 250 * count, 2e7 + 1000 * count, proof_tolerance(triangles),
          3e7 + 1000 * count};
}

struct IntegrationReport {
  /// Sum of the estimated errors of the nodal values over int |f| (0 for f = 0). Above the
  /// tolerance only if the work was limited. Infinite if no estimate is possible, since int f may
  /// not exist.
  double relative_error_estimate = 0;
  Proof proof;  ///< bounds of f - f_h
  std::size_t evaluations = 0;
  std::size_t cut_triangles = 0;  ///< triangles in which a jump or a kink was found
};

/// load_i = int f phi_i dx, shape (n), for the P1 hat functions of a triangulation.
/// `xy` (n,2) and `triangles` (m,3) row-major, index base 0, counterclockwise, areas > 0.
///
/// 1. The text shows where f can jump or bend (Tape::switches). Triangles in which the argument of
///    such a switch changes its sign are cut along that line (cut_cells.hpp).
/// 2. The others are integrated by 7 points, exactly for f of degree 4. The samples at these points
///    and at the corners give the terms of degree 1 to 4; their decay gives the error.
/// 3. Triangles that are not accurate enough go to refine_cells(): rules of degree 8 and 12, then
///    quarters. The arguments of exp, sin, 1/u and the like show where f has more than its samples.
///
/// Each triangle of area a is allowed relative_tolerance / 2 of (a mean|f| + its own int |f|).
/// Reproducible on one kind of processor. Memory O(m). About n + 7 m evaluations if f is smooth.
/// Triangles whose area is zero to rounding have no load. What the samples missed is added
/// (load_proof.hpp). Throws errors::Error (expression_invalid if f is not finite inside a triangle;
/// cancelled: it looks every few milliseconds). `parts`, if given, receives the load by triangles
/// and bounds of the rest; `spread` receives the values of f.
IntegrationReport integrate_load(std::span<const double> xy,
                                 std::span<const std::int32_t> triangles,
                                 const expression::Function& f, std::span<double> load,
                                 const IntegrationLimits& limits = {}, ForceParts* parts = nullptr,
                                 std::vector<Spread>* spread = nullptr);

}  // namespace anticrack::fem
