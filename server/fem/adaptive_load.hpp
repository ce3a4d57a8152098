// SPDX-License-Identifier: GPL-3.0-or-later
//
// The load vector of an expression.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>

#include "expression/function.hpp"

namespace anticrack::fem {

struct IntegrationLimits {
  /// Of int |f|.
  double relative_tolerance = 1e-10;
  /// What may be done beyond the first samples of every triangle, ns, roughly. Counted in
  /// operations, so it always ends at the same point.
  double work = 1e9;
  /// What those first samples may take, ns, roughly. A text too long for it is taken for linear
  /// between the nodes, and its error from some of the triangles.
  double first_work = 1e12;
};

struct IntegrationReport {
  /// Sum of the estimated errors of nodal values over int |f| (0 for f = 0). Above the tolerance
  /// only if the work ran out. Infinite: no estimate is possible, int f may not exist.
  double relative_error_estimate = 0;
  std::size_t evaluations = 0;
  std::size_t cut_triangles = 0;  ///< triangles in which a jump or a kink was found
};

/// load_i = int f phi_i dx, shape (n), for the P1 hat functions of a triangulation.
/// `xy` (n,2) and `triangles` (m,3) row-major, index base 0, counterclockwise, areas > 0.
///
/// 1. What can make f jump or bend is read off its text (Tape::switches): triangles in which such
///    an argument changes its sign are cut along that line (cut_cells.hpp).
/// 2. The others have 7 samples inside and those of their corners: exact for f of degree 4. How the
///    terms of degree 1 to 3 decay tells the error.
/// 3. What is not right to the tolerance by then goes on in refine_cells(): rules of degree 8 and
///    12, then quarters.
/// Arguments of exp, sin, 1/u and the like tell where f has more than its samples show.
///
/// Each triangle of area a is allowed relative_tolerance / 2 of (a mean|f| + its own int |f|).
/// Deterministic on one kind of processor. Memory O(m) at worst. About n + 7 m evaluations where f
/// is smooth. A triangle whose area is zero to rounding has no load. Throws errors::Error
/// (expression_invalid where f is not finite inside a triangle; cancelled soon after `stop` is
/// requested: after 10 ms of work at most).
IntegrationReport integrate_load(std::span<const double> xy,
                                 std::span<const std::int32_t> triangles,
                                 const expression::Function& f, std::span<double> load,
                                 const IntegrationLimits& limits = {}, std::stop_token stop = {});

}  // namespace anticrack::fem
