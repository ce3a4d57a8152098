// SPDX-License-Identifier: GPL-3.0-or-later
//
// A bound for the exact A of an inclusion, or for a component of its slope, from one side.
//
// Let sigma be in equilibrium with the load, and tau with a unit force on the goal; v = u_h + w,
// and z = 0 on the Dirichlet boundary. With p the pressure of sigma, q that of tau (of any sign),
// and for an upper bound
//
//   [z] <= c [v],   -q <= c p   on the cracks,
//   rho^2 = |sigma - T grad v|^2 / 4 + int p [v],   eta = |tau - T grad z|,
//   mid = A(v) + int q [v] + l(z) - a(v, z) + 1/2 int (tau - T grad z).(sigma/T - grad v):
//
//   A <= mid + R(c),   R(c) = min over c' >= c of c' E + M + F / c'
//   E = rho^2,  M = 0,  F = eta^2 / 4,   so R = eta rho if 2 c rho <= eta.
//
// A lower bound needs -[z] <= c [v] and q <= c p, and A >= mid - R(c). Towards ends of contact
// zones c may grow: with a Weight and  D = (grad v - sigma / T) / 2,
//
//   [z] <= c w [v],   -q <= c k p,   h = w - b,
//   E = int (w + b + b^2 / h) T |D|^2 + int w p [v],   M = int b/h |tau - T grad z| |D|,
//   F = int |tau - T grad z|^2 / (4 h T).
//
// If T varies on triangles, eta and rho are bounded as in bracket.hpp, mid is computed with the
// mean of T, and its error is added to R; with w, |T grad w| is added to |sigma - T grad u_h|, and
// spread |grad z|_h |w| to R for a(v, z), and half of it for mid. A Weight needs both T constant
// and w = 0.
//
// With a StiffPart, c may differ between it (t) and the rest (s). For eta_p = |tau - T grad z|_p,
// d_p = |D|_p, E_p = d_p^2 + P_p of each part and any c_t, c_s that hold the cones of both,
//
//   R <= c_t E_t + c_s E_s + g d_t d_s + (c_s a^2 + c_t b^2 + g a b) / (4 c_t c_s - g^2),
//   g = coupling |c_t - c_s|,  a = eta_t + g d_s,  b = eta_s + g d_t,  if 4 c_t c_s > g^2.
//
// With c_t = k c_s this is c_s E + M + F / c_s again, and k = 1 the formula without parts. What
// sigma does not balance takes o_t/2 and 3 o_s/2 beside d_t and d_s in g d_t d_s, a and b.
//
// The rest of the load, which sigma does not balance (LoadBalance: o, moments), moves the bound
// outwards: |D| takes o/2 more on each triangle, M half of sum o |tau - T grad z|, and R what the
// rest may be of l(z). In the triangles of a Weight it moves A by `unloaded` times its norm. So do
// s and t, which sigma and tau lack of equilibrium (lack.hpp): eta + |t| and |sigma - T grad v| +
// |s| take the place of eta and |sigma - T grad v|, and mid is computed from sigma and tau alone
// with l(z) - a(u_h, z) = sum of w [z] over the ends of minus faces, w the flux of sigma through
// them, which is wrong by at most
//   work max |z| + (eta |s| + |t| |sigma - T grad v| + |s| |t|) / 2.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "estimate/boundary_lift.hpp"
#include "estimate/equilibrated_flux.hpp"
#include "estimate/lack.hpp"
#include "estimate/load_balance.hpp"
#include "estimate/stiff_part.hpp"
#include "estimate/weight.hpp"

namespace anticrack::estimate {

/// The discrete answer and its flux.
struct Primal {
  const CutMesh& cut;
  const EquilibratedFlux& flux;
  const LoadBalance& load;
  const std::vector<Lift>& lifts;
  std::span<const double> u;         ///< (copies)
  Lack lack{};                       ///< of the flux
  const StiffPart* stiff = nullptr;  ///< null: none
  double largest = largest_of(u);    ///< max |u|
};

enum class Side : std::uint8_t { lower, upper };

/// c of the cone, which is `stiff` times as large on contacts of a StiffPart.
struct ConeSize {
  double c = 0;
  double stiff = 1;
};

/// The dual solution. z and tau need not solve any equation.
struct Dual {
  std::span<const double> z;         ///< (copies)
  std::span<const double> reacting;  ///< (copies) z', from which tau is made
  double value = 0;                  ///< A(u_h)
  Side side = Side::upper;           ///< which bound
  double c = 0;                      ///< the most that c may be
  std::span<const ForceOn> unit;     ///< (inclusions) the force that tau balances
  const Weight* weight = nullptr;    ///< null: 1
  double stiff = 1;                  ///< ConeSize::stiff; 1 with a weight

  /// The most that c may be on a face.
  double c_on(const Primal& primal, std::size_t face) const {
    const bool in =
        primal.stiff != nullptr && primal.stiff->has_face(primal.cut, primal.cut.faces[face]);
    return in ? stiff * c : c;
  }
};

/// Sums over the triangles with the part o of the load that is not balanced.
struct Unbalanced {
  double squared = 0;  ///< o^2
  double primal = 0;   ///< o |sigma - T grad v|
  double dual = 0;     ///< o |tau - T grad z|
};

/// What a Weight adds to |sigma - T grad v|^2, to 2 M, and to |tau - T grad z|^2; bounds of w + b +
/// b^2/h, b/h and 1/h.
struct Weighted {
  double primal = 0, mixed = 0, dual = 0;
  double most_primal = 1, most_mixed = 0, most_dual = 1;
};

/// The terms of the stiff part or of the rest, as in Terms.
struct PartTerms {
  double distance = 0, square = 0, pressure = 0;
  Unbalanced unbalanced{};
  double c = 0;  ///< of the cone there
};

/// What a bound is made of, in the symbols above.
struct Terms {
  double value = 0;     ///< A(u_h)
  double work = 0;      ///< int q [v]
  double residual = 0;  ///< l(z) - a(v, z)
  double mixed = 0;     ///< 1/2 int (tau - T grad z).(sigma/T - grad v)
  double distance = 0;  ///< |sigma - T grad v|^2
  double square = 0;    ///< |tau - T grad z|^2
  double pressure = 0;  ///< int w p [v]
  double s = 0, t = 0;  ///< |s| and |t|
  Unbalanced unbalanced{};
  double extra = 0;  ///< all else by which A may differ
  Weighted weighted{};
  std::array<PartTerms, 2> parts{};  ///< the rest, and the stiff part
  double coupling = -1;              ///< StiffPart::coupling; negative: there are no parts
};

/// The terms of R(c).
struct HalfWidth {
  double primal = 0, mixed = 0, dual = 0;  ///< E, M, F
  double operator()(double c) const;
  double best(double c) const;  ///< the c' >= c of the minimum; infinite if E = 0
};

struct Bound {
  double value = std::numeric_limits<double>::infinity();  ///< not finite: there is none
  double estimate = 0;                                     ///< estimate of A - A(u_h), not a bound
  double short_of = 0;  ///< eta / (2 c rho): if above 1, a larger c is probably better
  double used = 0;      ///< part of the cone that z and tau take
  // mid, c_s, and R of the formulas above, for c_t = stiff c_s.
  double middle = 0, c = 0, stiff = 1;
  HalfWidth half{};
  /// With a StiffPart: the cone that these z and tau would have the best R with.
  std::optional<ConeSize> wanted{};
  /// (m) the parts of the triangles in c' E + F / c' at the best c', if Aimed::parts asks for them.
  std::vector<double> parts{};
};

/// R for c_t = stiff c_s of parts with these E_p, eta_p, and d_p of the products of both.
struct PartNorms {
  double energy = 0, flux = 0, reach = 0;
};
std::optional<HalfWidth> half_of_parts(const std::array<PartNorms, 2>& of, double coupling,
                                       double stiff);

/// The bound made of these terms, if z and tau obey the cone of `c`, in that of `most`.
Bound bound_of(const Terms& terms, Side side, double c, double most);

/// Most cones to try, of which most answers need one.
constexpr int most_cones = 4;

/// A cone to try, and |z' - z|^2 for z and z' that are clipped to it, which jumps and forces of the
/// contacts tell before there is a field; NaN: it is not known.
struct Clipped {
  double c = 0;
  double apart = std::numeric_limits<double>::quiet_NaN();
};

/// The first cone where nothing is known of what it clips, for a goal of this compliance and |u|^2;
/// and cones about it to choose from.
double first_cone(double compliance, double norm_squared);
std::vector<double> cones_about(double first);

/// The cone with the least R where E = `primal` and F = `dual` + |z' - z|^2 / 4, `dual` without
/// clipping. F is that if tau - T grad z' and z' - z are orthogonal, as they nearly are.
struct Promise {
  Clipped cone;
  double half_width = std::numeric_limits<double>::infinity();  ///< R
};
Promise choose_cone(std::span<const Clipped> of, double primal, double dual);

/// The cone to try after `last` gave `found`: of those known, if it promises to take off a part of
/// R that is worth the fields; else a wider one, if there is no bound yet or a larger c is probably
/// better. None: `last` is good enough.
std::optional<Clipped> next_cone(std::span<const Clipped> known, const Clipped& last,
                                 const Bound& found);

/// The tau of a Dual: on one side of 0, q is within c k p at each end of a face.
EquilibratedFlux dual_flux(const Primal& primal, const Dual& dual);

/// A dual for an answer. `unloaded`: |tau| of a tau with q = 0, for the oscillation in a weight's
/// triangles.
struct Aimed {
  const Primal* primal;
  Dual dual;
  double unloaded = 0;
  bool parts = false;  ///< fill Bound::parts
};

/// The bound by a tau. There is none if z or tau leave the cone. O(m).
Bound bound(const Aimed& aimed, const EquilibratedFlux& tau);
/// The bounds by several duals at once, with their dual_flux; the bits of each are as if it were
/// alone. O(m) each.
std::vector<Bound> bounds(const CutMesh& cut, std::span<const Aimed> of);

}  // namespace anticrack::estimate
