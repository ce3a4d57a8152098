// SPDX-License-Identifier: GPL-3.0-or-later
//
// The load that a flux balances, and a bound of the part that it does not.
#pragma once

#include <vector>

#include "estimate/cut_mesh.hpp"
#include "estimate/equilibrated_flux.hpp"
#include "fem/load_parts.hpp"

namespace anticrack::estimate {

using fem::j_11;

/// A load on all subdomains, in the order of CutMesh.
struct LoadBalance {
  std::vector<double> force;     ///< as Balance::force
  std::vector<double> traction;  ///< as Balance::traction; empty: 0
  /// (triangles) o with |int (f - f_h) v + int (g - g_h) v| <= sum of o |grad v| for all v that are
  /// 0 on the Dirichlet boundary, where the flux balances f_h and g_h:
  ///   h/(j_11 sqrt(T)) |f - f_h| + sqrt(0.329 |e| h^2/(|K| T)) |g - g_h|_e + |tau|;  empty: 0.
  /// h is the diameter, T the least tension in any direction (times Variation::below if it varies),
  /// and j_11 comes from the Poincare constant of triangles, Laugesen & Siudeja (2009). The flux
  /// tau carries the unknown parts of int_K f and int_e g to the boundary along CutMesh::ways_out:
  /// since |v| is as smooth as v and 0 there too, int |v| s = int tau.grad |v| for the sources s of
  /// tau.
  std::vector<double> oscillation;
  /// (triangles) m with |int_K (f - f_h) z| <= m max |z| for linear z; infinite on triangles where
  /// int (g - g_h) z is not known. Empty if `oscillation` is.
  std::vector<double> moments;
  /// Sum over the triangles and edges of what is unknown of the integral of the load.
  double unknown = 0;
};

/// `load`: becomes LoadBalance::force; `force`: what it lacks, per subdomain, whose own `load` is
/// not read; `traction`: per subdomain, or empty. O(m). The oscillation is infinite if an unknown
/// part has no way to the boundary.
LoadBalance load_balance(const CutMesh& cut, std::vector<double> load,
                         const std::vector<fem::ForceParts>& force,
                         const std::vector<fem::TractionParts>& traction);

}  // namespace anticrack::estimate
