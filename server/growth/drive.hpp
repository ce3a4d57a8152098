// SPDX-License-Identifier: GPL-3.0-or-later
//
// The loads at which fronts start beside a dead load: u(t) solves dead + t live, with contact.
// Between two changes of the contact set u is affine in t and G quadratic, and it need not rise: a
// live load may close a front. So t goes from one change of the set to the next, as in parametric
// quadratic programming (Best, An algorithm for the solution of the parametric quadratic
// programming problem, 1996), and G = Gc is solved on each piece.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "growth/evolution.hpp"

namespace anticrack::growth {

/// Loads that differ by less are reported as a tie.
constexpr double tie = 0.01;

/// c[0] + c[1] t + c[2] t^2.
struct Quadratic {
  std::array<double, 3> c{};
  double at(double t) const { return c[0] + t * (c[1] + t * c[2]); }
};

/// The quadratic with these values at 0 and of t^2, and `together` at t = 1.
Quadratic polarised(double at_0, double of_square, double together);

/// G of a front by the integral over three radii, which has the value of the first unless that is
/// little beside their spread: then the front is closed.
struct Rates {
  std::array<Quadratic, 3> by_radius{};
  double at(double t) const;
};
/// The value that such integrals stand for.
double rate_of(const std::array<double, 3>& by_radius);

/// What holds from one t to another.
struct Piece {
  double end = 0;            ///< infinite or 0: no change follows
  std::vector<Rates> rates;  ///< of each front
};
/// The piece that begins at t, upwards (way 1) or downwards (-1).
using Pieces = std::function<Piece(double t, int way)>;

/// For each front of which `grows` is 1 the load at which it starts, as an increasing t would have
/// it: where G at Sought::highest is below Gc, the least t above with G = Gc. Where it is not, the
/// front runs at that load, and its load is the one to which t would have to fall: from the row
/// before upwards if G is below Gc there, else downwards; 0: the dead load alone is enough. Loads
/// more than a tie above the least are left infinite.
Driven drive(const Pieces& pieces, const Sought& sought, const std::vector<char>& grows);

}  // namespace anticrack::growth
