// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bounds of the exact energy of the membrane and of the error of a discrete solution, without
// knowing the exact solution u: for any flux sigma in equilibrium with the load, and v = u_h + w
// with the exact boundary values (boundary_lift.hpp; w = 0 if they are linear along edges),
//
//   Pi(v) - Pi(u) <= eta^2 / 2 + P,   |u - v| <= (eta + sqrt(eta^2 + 4 P)) / 2,
//   eta = |sigma - T grad v|,   P = int p_s [v],   Pi(u) <= Pi(v).
//
// This is Prager & Synge's hypercircle with contact, for the polygonal membrane. If T varies on a
// triangle, with mean T_h, Pi(u_h) and |u_h| are exact, as grad u_h is constant, and
//
//   |sigma - T grad u_h| <= max sqrt(T_h/T) |sigma - T_h grad u_h|_h + spread |grad u_h|_h
//
// in the norms of 1/T, with index h those of 1/T_h and T_h; spread^2 = mean of (T - T_h)^2 / (T
// T_h).
//
// If the discrete problem is not solved exactly, sigma is not quite in equilibrium: then Lack::flux
// is added to eta, and only the part p >= 0 of the pressure counts.
#pragma once

#include <span>
#include <vector>

#include "base/large.hpp"
#include "estimate/boundary_lift.hpp"
#include "estimate/equilibrated_flux.hpp"
#include "estimate/load_balance.hpp"

namespace anticrack::estimate {

/// Integrals of w over the triangle of a face, force times length.
struct LiftIntegrals {
  double norm = 0;     ///< |w|, the square root of gradient_squared
  double work = 0;     ///< int f w, f linear
  double product = 0;  ///< int T grad u_h . grad w
  double through = 0;  ///< int sigma.n phi
  double unknown = 0;  ///< >= the error of the last three together
  /// int (sigma - T grad u_h) . grad w
  double difference() const noexcept { return work + through - product; }
};
LiftIntegrals integrals_of(const CutMesh& cut, const EquilibratedFlux& flux,
                           const LoadBalance& load, const Lift& lift, std::span<const double> u);

/// Whether T max |u|^2 says something: u is 0, or its square is far from vanishing and overflow.
bool in_range(double tension, double largest) noexcept;

/// Allows for rounding in bounds of an energy without interval arithmetic: it is some 1e-14, also
/// of products of u that cancel, as in a membrane that is lifted. `norm_squared`: |u_h|^2;
/// `largest`: max |u_h|.
double rounding_of(double energy, double norm_squared, double tension, double largest) noexcept;

struct Bracket {
  double lower = 0;  ///< bound of the exact Pi, force times length
  double upper = 0;
  double error = 0;           ///< >= |u - u_h|, |v|^2 = int T |grad v|^2
  double error_relative = 0;  ///< error / |u_h|
  double distance = 0;        ///< >= eta, with what sigma lacks and does not balance
  double work = 0;            ///< P
  /// (triangles of CutMesh) the part of each triangle in eta^2 + 2 P.
  base::Large<double> indicator;
};

/// `u`: u_h in the copies; `energy`: Pi(u_h). The flux balances `load` up to `lack` (Lack::flux)
/// and is near T grad u_h. O(m).
Bracket bracket(const CutMesh& cut, const EquilibratedFlux& flux, const LoadBalance& load,
                const std::vector<Lift>& lifts, std::span<const double> u, double energy,
                double lack = 0);

}  // namespace anticrack::estimate
