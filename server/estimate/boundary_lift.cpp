// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/boundary_lift.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/at.hpp"
#include "estimate/edge_polynomial.hpp"
#include "stop/stop.hpp"

namespace anticrack::estimate {
namespace {

constexpr std::size_t points = EdgePolynomial::points, halves = BoundarySamples::halves;

double length_of(const Vector& v) { return std::hypot(v[0], v[1]); }

/// Adds the part of r = g_D - its polynomials, which is 0 in some points of each half.
void add_unknown(Lift& lift, double slope, const Vector& second, const Vector& third, double area) {
  const double most = std::sqrt(1.0 / halves) * slope;  // bound of |r|
  const Vector both{second[0] + third[0], second[1] + third[1]};
  const double gradient = std::max(length_of(second), length_of(both)) * slope +
                          length_of(third) * most;  // |r' (second + s third) - r third|
  const double norm = std::sqrt(lift.gradient_squared) + std::sqrt(area) * gradient;
  lift.gradient_squared = norm * norm;
  lift.unknown = most;
}

}  // namespace

std::vector<Lift> lifts(const CutMesh& cut, const BoundarySamples& samples,
                        std::span<const double> u) {
  std::vector<Lift> result;
  const double* sample = samples.values.data();
  for (std::size_t f = 0; f < cut.faces.size(); ++f) {
    stop::look_at_turn(f, "lifting the boundary");
    if (!has_boundary_value(cut.faces[f])) continue;
    const auto corners = corners_of(cut.faces[f]);
    // The vectors from P_1 to P_2 and from P_3 to P_1.
    const Vector side = cut.shapes.side(corners[2]), back = cut.shapes.side(corners[1]);
    const double area = 0.5 * (side[1] * back[0] - side[0] * back[1]);
    // Gradients of l_2 and l_3.
    const Vector second{-back[1] / (2 * area), back[0] / (2 * area)};
    const Vector third{-side[1] / (2 * area), side[0] / (2 * area)};
    const double at_p = u[at(cut.copy[corners[0]])], at_q = u[at(cut.copy[corners[1]])];
    Lift lift{static_cast<std::int32_t>(f)};
    for (std::size_t half = 0; half < halves; ++half) {
      EdgePolynomial::Values phi{};
      const auto place = [&](std::size_t k) {
        return (static_cast<double>(half) + fem::line_5.at[k]) / halves;
      };
      for (std::size_t k = 0; k < points; ++k)
        phi[k] = *sample++ - (at_p + place(k) * (at_q - at_p));
      const EdgePolynomial polynomial(phi);
      for (std::size_t k = 0; k < points; ++k) {
        const double s = place(k), weight = fem::line_5.weight[k] / halves;
        const double along = halves * polynomial(fem::line_5.at[k] - 0.5, 1);
        const Vector gradient{along * second[0] + (along * s - phi[k]) * third[0],
                              along * second[1] + (along * s - phi[k]) * third[1]};
        lift.mean += weight * phi[k];
        lift.first += weight * s * phi[k];
        lift.gradient_squared +=
            weight * area * (gradient[0] * gradient[0] + gradient[1] * gradient[1]);
      }
    }
    add_unknown(lift, samples.unknown[result.size()], second, third, area);
    result.push_back(lift);
  }
  return result;
}

}  // namespace anticrack::estimate
