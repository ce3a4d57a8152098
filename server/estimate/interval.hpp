// SPDX-License-Identifier: GPL-3.0-or-later
//
// An interval for a displacement of the membrane: A of an inclusion, or a component of its slope.
//
// sigma in equilibrium with the load, tau with a unit force on the goal; v = u_h + w, z = 0 on the
// Dirichlet boundary. With p the pressure of sigma, q that of tau (of any sign), and
//
//   -c_l [v] <= [z] <= c_u [v],   -c_u p <= q <= c_l p   on the cracks,
//   rho^2 = |sigma - T grad v|^2 / 4 + int p [v],   eta = |tau - T grad z|,
//   mid = A(v) + int q [v] + l(z) - a(v, z) + 1/2 int (tau - T grad z).(sigma/T - grad v):
//
//   mid - R(c_l) <= A <= mid + R(c_u),
//   R(c) = eta rho  if 2 c rho <= eta,  else  c rho^2 + eta^2 / (4 c).
//
// Where T varies on triangles, eta and rho are bounded as in bracket.hpp, mid is that of the mean
// and R has its error; not where w is not 0.
//
// Guaranteed for the load that sigma balances; a load beyond (LoadBalance::oscillation) widens it.
// So does what sigma and tau lack of equilibrium (lack.hpp), s and t: eta + |t| and
// |sigma - T grad v| + |s| take the place of eta and |sigma - T grad v|, and mid is that of sigma
// and tau alone with l(z) - a(u_h, z) = 0, which is wrong by at most
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

/// Where u_h is closed, [z] = 0: it takes no part in l(z) - a(u_h, z), which is 0 then.
struct Dual {
  std::span<const double> z;         ///< (copies)
  std::span<const double> reacting;  ///< (copies) what tau is made for
  double value = 0;                  ///< A(u_h)
  double c = 0;                      ///< bound of c_l and c_u
  std::span<const ForceOn> unit;     ///< (inclusions) what tau balances
};

struct Interval {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  double estimate = 0;  ///< of A - A(u_h), no bound
  double short_of = 0;  ///< eta / (2 c rho): a larger c is better about where it is above 1
  // What it is made of; c_l, c_u.
  double middle = 0, eta = 0, rho = 0, below = 0, above = 0;
  double width() const noexcept { return upper - lower; }
};

/// R(c).
double half_width(double c, double eta, double rho);

/// The tau of a Dual, next to a flux sigma: |q| <= c p on each end of a face.
EquilibratedFlux dual_flux(const CutMesh& cut, const EquilibratedFlux& sigma, const Dual& dual);

/// A dual of an answer. `unloaded`: norm of a tau without q, of which the oscillation takes its
/// share.
struct Aimed {
  const Primal* primal;
  Dual dual;
  double unloaded = 0;
};

/// Of several at once, with the bits of each alone. Infinite where z or tau leave the cone, or
/// where T varies on triangles and w is not 0. O(m) each.
std::vector<Interval> intervals(const CutMesh& cut, std::span<const Aimed> of);
Interval interval(const Primal& primal, const Dual& dual, double unloaded);

/// |tau| of a tau for a unit force with all cracks free; infinite where `reacting` is empty. Of
/// several at once, with the bits of each alone. `units`: as Dual::unit, of each. O(m) each.
std::vector<double> norms_of_fluxes(const CutMesh& cut,
                                    std::span<const std::vector<double>> reacting,
                                    std::span<const std::vector<ForceOn>> units);

}  // namespace anticrack::estimate
