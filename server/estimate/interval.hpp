// SPDX-License-Identifier: GPL-3.0-or-later
//
// An interval for the exact A of an inclusion, or for a component of its slope.
//
// Let sigma be in equilibrium with the load, and tau with a unit force on the goal; v = u_h + w,
// and z = 0 on the Dirichlet boundary. With p the pressure of sigma, q that of tau (of any sign),
// and
//
//   -c_l [v] <= [z] <= c_u [v],   -c_u p <= q <= c_l p   on the cracks,
//   rho^2 = |sigma - T grad v|^2 / 4 + int p [v],   eta = |tau - T grad z|,
//   mid = A(v) + int q [v] + l(z) - a(v, z) + 1/2 int (tau - T grad z).(sigma/T - grad v):
//
//   mid - R(c_l) <= A <= mid + R(c_u),
//   R(c) = eta rho  if 2 c rho <= eta,  else  c rho^2 + eta^2 / (4 c).
//
// If T varies on triangles, eta and rho are bounded as in bracket.hpp, mid is computed with the
// mean of T, and its error is added to R. This needs w = 0.
//
// The interval is guaranteed for the load that sigma balances; the rest of the load
// (LoadBalance::oscillation) widens it. So do s and t, which sigma and tau lack of equilibrium
// (lack.hpp): eta + |t| and |sigma - T grad v| + |s| take the place of eta and |sigma - T grad v|,
// and mid is computed from sigma and tau alone with l(z) - a(u_h, z) = 0, which is wrong by at most
//   work max |z| + (eta |s| + |t| |sigma - T grad v| + |s| |t|) / 2.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "estimate/boundary_lift.hpp"
#include "estimate/equilibrated_flux.hpp"
#include "estimate/lack.hpp"
#include "estimate/load_balance.hpp"

namespace anticrack::estimate {

/// The discrete answer and its flux.
struct Primal {
  const CutMesh& cut;
  const EquilibratedFlux& flux;
  const LoadBalance& load;
  const std::vector<Lift>& lifts;
  std::span<const double> u;  ///< (copies)
  Lack lack{};                ///< of the flux
};

/// The dual solution. [z] = 0 where u_h is closed, so that l(z) - a(u_h, z) = 0.
struct Dual {
  std::span<const double> z;         ///< (copies)
  std::span<const double> reacting;  ///< (copies) z', from which tau is made
  double value = 0;                  ///< A(u_h)
  double c = 0;                      ///< bound of c_l and c_u
  std::span<const ForceOn> unit;     ///< (inclusions) the force that tau balances
};

struct Interval {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  double estimate = 0;  ///< estimate of A - A(u_h), not a bound
  double short_of = 0;  ///< eta / (2 c rho): if above 1, a larger c is probably better
  // mid, eta, rho, c_l and c_u of the formulas above.
  double middle = 0, eta = 0, rho = 0, below = 0, above = 0;
  double width() const noexcept { return upper - lower; }
};

/// R(c) of the formula above.
double half_width(double c, double eta, double rho);

/// The tau of a Dual: |q| <= c p at each end of a face, with p the pressure of sigma.
EquilibratedFlux dual_flux(const CutMesh& cut, const EquilibratedFlux& sigma, const Dual& dual);

/// A dual for an answer. `unloaded`: |tau| of a tau with q = 0, which multiplies the oscillation.
struct Aimed {
  const Primal* primal;
  Dual dual;
  double unloaded = 0;
};

/// The intervals of several duals at once; the bits of each are as if it were alone. Infinite if z
/// or tau leave the cone, or if T varies on triangles and w is not 0. O(m) each.
std::vector<Interval> intervals(const CutMesh& cut, std::span<const Aimed> of);
Interval interval(const Primal& primal, const Dual& dual, double unloaded);

/// |tau| of fluxes tau for unit forces with all cracks free; infinite where `reacting` is empty.
/// The bits of each are as if it were alone. `units`: Dual::unit of each. O(m) each.
std::vector<double> norms_of_fluxes(const CutMesh& cut,
                                    std::span<const std::vector<double>> reacting,
                                    std::span<const std::vector<ForceOn>> units);

}  // namespace anticrack::estimate
