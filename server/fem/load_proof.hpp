// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bounds, triangle by triangle, of an expression f that was integrated by samples: f_h is the
// linear function with the moments L_i of the load, and f - f_h is bounded by interval arithmetic
// (expression/enclosure.hpp), which sees what lies between the samples.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "expression/function.hpp"
#include "expression/interval.hpp"
#include "fem/load_parts.hpp"

namespace anticrack::fem {

/// The values of f on a triangle.
struct Spread {
  expression::Interval values;
  double deviation = 0;  ///< >= root of the mean of (f - mean f)^2, with the mean as integrated
};

struct ProofOptions {
  /// If less than this is unknown of int f, relative to int |f|, nothing is divided further.
  double tolerance = 1e-4;
  double work = 1e9;          ///< roughly in ns; counted, so that results are reproducible
  double absolute = 0;        ///< int |f| from the samples
  double area = 0;            ///< of all triangles
  bool exact = false;         ///< rules of degree 5 integrate f phi_i exactly
  bool interpolated = false;  ///< L is that of the interpolant, not of rules of degree 5 or more
  std::span<const char> curved = {};  ///< (m) 1: L is of no such rule; empty: none is
  /// If given, receives tight bounds of f on the triangles.
  std::vector<Spread>* spread = nullptr;
};

struct Proof {
  double unknown = 0;   ///< >= sum over the triangles of |int (f - f_h)|
  double absolute = 0;  ///< int |f|, roughly
  /// unknown / absolute; 0 if nothing is unknown.
  double relative() const { return unknown > 0 ? unknown / absolute : 0; }
  std::size_t boxes = 0;              ///< number of boxes enclosed, also for quarters
  double worst_x = 0, worst_y = 0;    ///< the middle of the triangle where most is unknown
  double lowest_x = 0, lowest_y = 0;  ///< with `spread`: where f may be least
};

/// Fills `parts.beyond` and `parts.unknown`. Replaces the moments L of triangles that are proved to
/// be wrong, as where samples missed a peak, and adds the difference to `load` (n).
///
/// Boxes of triangles are enclosed first. The box of all triangles is divided as far as f or its
/// third derivatives vary, so a smooth f takes a few boxes. Triangles with jumps, kinks and peaks
/// are quartered, beginning with the one of which most is unknown. Throws errors::Error
/// (cancelled). O(m + boxes and quarters).
Proof prove_load(std::span<const double> xy, std::span<const std::int32_t> triangles,
                 const expression::Function& f, ForceParts& parts, std::span<double> load,
                 const ProofOptions& options);

}  // namespace anticrack::fem
