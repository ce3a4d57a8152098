// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bounds of the membrane's energy, and of the error of a discrete solution, without knowing the
// membrane's own: for any flux sigma in equilibrium with the load,
//
//   Pi(u_h) - Pi(u) <= |sigma - T grad u_h|^2 / 2 + int p_s [u_h]  =: delta,
//   |u - u_h| <= (eta + sqrt(eta^2 + 4 P)) / 2,   eta = |sigma - T grad u_h|, P = int p_s [u_h].
//
// Prager & Synge's hypercircle under contact; the polygonal membrane is meant, and exact loads.
#pragma once

#include <span>
#include <vector>

#include "estimate/equilibrated_flux.hpp"

namespace anticrack::estimate {

struct Bracket {
  double lower = 0;           ///< of the membrane's Pi, force times length
  double upper = 0;           ///< the same: Pi(u_h)
  double error = 0;           ///< >= |u - u_h|, |v|^2 = int T |grad v|^2
  double error_relative = 0;  ///< over |u_h|
  std::vector<double>
      indicator;  ///< (triangles of CutMesh) its part of |sigma - T grad u_h|^2 + 2 P
};

/// `energy`: Pi(u_h). `oscillation`: (triangles) what the flux does not balance exactly, as a bound
/// of its effect, o_K in |sigma - T grad u_h|_K + o_K; empty: 0. `widening`: relative inaccuracy of
/// the load. O(m).
Bracket bracket(const CutMesh& cut, const EquilibratedFlux& flux, double energy,
                std::span<const double> oscillation);

}  // namespace anticrack::estimate
