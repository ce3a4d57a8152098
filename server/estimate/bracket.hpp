// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bounds of the membrane's energy, and of the error of a discrete solution, without knowing the
// membrane's own: for any flux sigma in equilibrium with the load, and v = u_h + w with the exact
// boundary values (boundary_lift.hpp; w = 0 where they are linear along edges),
//
//   Pi(v) - Pi(u) <= eta^2 / 2 + P,   |u - v| <= (eta + sqrt(eta^2 + 4 P)) / 2,
//   eta = |sigma - T grad v|,   P = int p_s [v],   Pi(u) <= Pi(v).
//
// Prager & Synge's hypercircle with contact. The polygonal membrane is meant.
#pragma once

#include <vector>

#include "estimate/boundary_lift.hpp"
#include "estimate/equilibrated_flux.hpp"
#include "estimate/load_balance.hpp"

namespace anticrack::estimate {

struct Bracket {
  double lower = 0;  ///< of the membrane's Pi, force times length
  double upper = 0;
  double error = 0;           ///< >= |u - u_h|, |v|^2 = int T |grad v|^2
  double error_relative = 0;  ///< over |u_h|
  /// (triangles of CutMesh) their parts of eta^2 + 2 P.
  std::vector<double> indicator;
};

/// `energy`: Pi(u_h). The flux balances `load` and is near T grad u_h. O(m).
Bracket bracket(const CutMesh& cut, const EquilibratedFlux& flux, const LoadBalance& load,
                const std::vector<Lift>& lifts, double energy);

}  // namespace anticrack::estimate
