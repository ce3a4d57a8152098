// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a flux has to balance, and what it leaves.
#pragma once

#include <vector>

#include "estimate/cut_mesh.hpp"
#include "estimate/equilibrated_flux.hpp"
#include "fem/load_parts.hpp"

namespace anticrack::estimate {

/// First zero of the Bessel function J_1.
inline constexpr double j_11 = 3.8317059702075123;

/// A load on all subdomains, in the order of CutMesh.
struct LoadBalance {
  std::vector<double> force;     ///< as Balance::force
  std::vector<double> traction;  ///< as Balance::traction; empty: 0
  /// (triangles) bound of the effect of what is not balanced,
  ///   h/(j_11 sqrt(T)) |f - P_1 f| + sqrt(0.329 |e| h^2/(|K| T)) |g - mean g|_e ;  empty: 0.
  /// h and T after the map of the tension; where that varies, times Variation::below.
  /// P_1: projection on linear functions; j_11 from the Poincare constant of triangles, Laugesen &
  /// Siudeja (2009).
  std::vector<double> oscillation;
};

/// `traction`: per subdomain, or none. O(m).
LoadBalance load_balance(const CutMesh& cut, const std::vector<fem::ForceParts>& force,
                         const std::vector<fem::TractionParts>& traction);

}  // namespace anticrack::estimate
