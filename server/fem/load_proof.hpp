// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is proved of an expression f that was integrated by samples, triangle by triangle: f_h is
// the linear function with the moments L_i of the load, and f - f_h is bounded by interval
// arithmetic (expression/enclosure.hpp). Samples cannot see what lies between them; this can.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "expression/function.hpp"
#include "expression/interval.hpp"
#include "fem/load_parts.hpp"

namespace anticrack::fem {

/// f on a triangle.
struct Spread {
  expression::Interval values;
  double deviation = 0;  ///< >= root of the mean of (f - mean f)^2, the mean as integrated
};

struct ProofOptions {
  /// Where less is unknown of int f, relative to int |f|, nothing is divided further.
  double tolerance = 1e-4;
  double work = 1e9;          ///< ns, roughly; counted, so that results are reproducible
  double absolute = 0;        ///< int |f| by the samples
  double area = 0;            ///< of all triangles
  bool exact = false;         ///< rules of degree 5 integrate f phi_i exactly
  bool interpolated = false;  ///< L are those of the interpolant; else of rules of degree 5 or more
  std::span<const char> curved = {};  ///< (m) 1: L are of no such rule; empty: none
  /// Receives f on the triangles, if wanted: closely.
  std::vector<Spread>* spread = nullptr;
};

struct Proof {
  double unknown = 0;   ///< >= sum over the triangles of |int (f - f_h)|
  double absolute = 0;  ///< int |f|, roughly
  /// unknown / absolute; 0 where nothing is unknown.
  double relative() const { return unknown > 0 ? unknown / absolute : 0; }
  std::size_t boxes = 0;              ///< enclosed in all, also of quarters
  double worst_x = 0, worst_y = 0;    ///< the middle of the triangle where most is unknown
  double lowest_x = 0, lowest_y = 0;  ///< with `spread`: where f may be least
};

/// Fills `parts.beyond` and `parts.unknown`. Replaces the moments L of triangles where they are
/// proved to be wrong, as where samples missed a peak, and adds what was missed to `load` (n).
///
/// Boxes of triangles are enclosed first, from that of all down, as far as f or its third
/// derivatives vary: a smooth f takes a few boxes. Triangles with jumps, kinks and peaks are
/// quartered, the one of which most is unknown first. Throws errors::Error (cancelled). O(m + boxes
/// and quarters).
Proof prove_load(std::span<const double> xy, std::span<const std::int32_t> triangles,
                 const expression::Function& f, ForceParts& parts, std::span<double> load,
                 const ProofOptions& options);

}  // namespace anticrack::fem
