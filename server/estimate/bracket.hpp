// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bounds of the membrane's energy, and of the error of a discrete solution, without knowing the
// membrane's own: for any flux sigma in equilibrium with the load, and v = u_h + w with the exact
// boundary values (boundary_lift.hpp; w = 0 where they are linear along edges),
//
//   Pi(v) - Pi(u) <= eta^2 / 2 + P,   |u - v| <= (eta + sqrt(eta^2 + 4 P)) / 2,
//   eta = |sigma - T grad v|,   P = int p_s [v],   Pi(u) <= Pi(v).
//
// Prager & Synge's hypercircle with contact. The polygonal membrane is meant. Where T varies on a
// triangle, T_h its mean there, Pi(u_h) and |u_h| are exact, as grad u_h is constant, and
//
//   |sigma - T grad u_h| <= max sqrt(T_h/T) |sigma - T_h grad u_h|_h + spread |grad u_h|_h
//
// in the norms of 1/T, and with index h of 1/T_h and T_h; spread^2 = mean of (T - T_h)^2 / (T T_h).
//
// Where the discrete problem is not solved exactly sigma is not quite in equilibrium: Lack::flux is
// added to eta, and of the pressure only p >= 0 counts.
#pragma once

#include <span>
#include <vector>

#include "estimate/boundary_lift.hpp"
#include "estimate/equilibrated_flux.hpp"
#include "estimate/load_balance.hpp"

namespace anticrack::estimate {

/// Integrals of w over the triangle of a face, force times length.
struct LiftIntegrals {
  double norm = 0;     ///< |w|, its square root
  double work = 0;     ///< int f w, f linear
  double product = 0;  ///< int T grad u_h . grad w
  double through = 0;  ///< int sigma.n phi
  double unknown = 0;  ///< >= what the last three are wrong by, in all
  /// int (sigma - T grad u_h) . grad w
  double difference() const noexcept { return work + through - product; }
};
LiftIntegrals integrals_of(const CutMesh& cut, const EquilibratedFlux& flux,
                           const LoadBalance& load, const Lift& lift, std::span<const double> u);

struct Bracket {
  double lower = 0;  ///< of the membrane's Pi, force times length
  double upper = 0;
  double error = 0;           ///< >= |u - u_h|, |v|^2 = int T |grad v|^2
  double error_relative = 0;  ///< over |u_h|
  /// (triangles of CutMesh) their parts of eta^2 + 2 P.
  std::vector<double> indicator;
};

/// `u`: u_h in the copies, `energy`: Pi(u_h). The flux balances `load` but for `lack`
/// (Lack::flux), and is near T grad u_h. O(m).
Bracket bracket(const CutMesh& cut, const EquilibratedFlux& flux, const LoadBalance& load,
                const std::vector<Lift>& lifts, std::span<const double> u, double energy,
                double lack = 0);

}  // namespace anticrack::estimate
