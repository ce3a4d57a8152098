// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/boundary_lift.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "fem/triangle_rules.hpp"
#include "mesh/at.hpp"
#include "stop/stop.hpp"

namespace anticrack::estimate {
namespace {

constexpr std::size_t points = fem::line_5.size;
constexpr std::size_t halves = 2;

bool is_dirichlet(const Face& face) {
  return face.condition == Condition::free && face.inclusion < 0;
}

/// Corners of a face's ends 0 and 1, and the third.
std::array<std::size_t, 3> corners_of(const Face& face) {
  const std::size_t t = at(face.side / 3), i = at(face.side % 3);
  return {3 * t + (i + 1) % 3, 3 * t + (i + 2) % 3, 3 * t + i};
}

double place(std::size_t half, std::size_t k) {
  return (static_cast<double>(half) + fem::line_5.at[k]) / halves;
}

/// Derivatives at the points of the polynomial through values there.
std::array<double, points> derivatives(const std::array<double, points>& values) {
  const auto& x = fem::line_5.at;
  std::array<double, points> result{};
  for (std::size_t i = 0; i < points; ++i) {
    for (std::size_t j = 0; j < points; ++j) {
      double slope = 0;  // of the j-th basis polynomial at the i-th point
      for (std::size_t m = 0; m < points; ++m) {
        if (m == j) continue;
        double product = 1 / (x[j] - x[m]);
        for (std::size_t n = 0; n < points; ++n)
          if (n != j && n != m) product *= (x[i] - x[n]) / (x[j] - x[n]);
        slope += product;
      }
      result[i] += values[j] * slope;
    }
  }
  return result;
}

/// The same polynomial at 0 or 1.
double value_at(double end, const std::array<double, points>& values) {
  const auto& x = fem::line_5.at;
  double result = 0;
  for (std::size_t j = 0; j < points; ++j) {
    double basis = values[j];
    for (std::size_t m = 0; m < points; ++m)
      if (m != j) basis *= (end - x[m]) / (x[j] - x[m]);
    result += basis;
  }
  return result;
}

/// Whether the polynomials of the halves meet, and are 0 at the ends, as phi does and is.
bool is_smooth(const std::array<std::array<double, points>, halves>& phi, double size) {
  constexpr double most = 0.1, rounding = 1e-10;
  double largest = 0;
  for (const auto& half : phi)
    for (const double value : half) largest = std::max(largest, std::abs(value));
  const double miss = std::max({std::abs(value_at(0, phi[0])), std::abs(value_at(1, phi[1])),
                                std::abs(value_at(1, phi[0]) - value_at(0, phi[1]))});
  return largest <= rounding * size || miss <= most * largest;
}

}  // namespace

std::vector<double> lift_points(const CutMesh& cut) {
  std::vector<double> xy;
  for (const Face& face : cut.faces) {
    if (!is_dirichlet(face)) continue;
    const auto corners = corners_of(face);
    const Vector &p = cut.at[at(cut.copy[corners[0]])], &q = cut.at[at(cut.copy[corners[1]])];
    for (std::size_t half = 0; half < halves; ++half) {
      for (std::size_t k = 0; k < points; ++k) {
        const double s = place(half, k);
        for (std::size_t d = 0; d < 2; ++d) xy.push_back(p[d] + s * (q[d] - p[d]));
      }
    }
  }
  return xy;
}

std::vector<Lift> lifts(const CutMesh& cut, std::span<const double> samples,
                        std::span<const double> u) {
  std::vector<Lift> result;
  const double* sample = samples.data();
  for (std::size_t f = 0; f < cut.faces.size(); ++f) {
    stop::look_at_turn(f, "lifting the boundary");
    if (!is_dirichlet(cut.faces[f])) continue;
    const auto corners = corners_of(cut.faces[f]);
    // From P_1 to P_2, and from P_3 to P_1.
    const Vector side = cut.shapes.side(corners[2]), back = cut.shapes.side(corners[1]);
    const double area = 0.5 * (side[1] * back[0] - side[0] * back[1]);
    // Gradients of l_2 and l_3.
    const Vector second{-back[1] / (2 * area), back[0] / (2 * area)};
    const Vector third{-side[1] / (2 * area), side[0] / (2 * area)};
    const double at_p = u[at(cut.copy[corners[0]])], at_q = u[at(cut.copy[corners[1]])];
    Lift lift{static_cast<std::int32_t>(f)};
    std::array<std::array<double, points>, halves> of_halves{};
    double size = std::max(std::abs(at_p), std::abs(at_q));
    for (std::size_t half = 0; half < halves; ++half) {
      for (std::size_t k = 0; k < points; ++k) {
        const double s = place(half, k);
        size = std::max(size, std::abs(*sample));
        of_halves[half][k] = *sample++ - (at_p + s * (at_q - at_p));
      }
    }
    lift.smooth = is_smooth(of_halves, size);
    for (std::size_t half = 0; half < halves; ++half) {
      const std::array<double, points>& phi = of_halves[half];
      const std::array<double, points> slope = derivatives(phi);
      for (std::size_t k = 0; k < points; ++k) {
        const double s = place(half, k), weight = fem::line_5.weight[k] / halves;
        const double along = halves * slope[k];
        const Vector gradient{along * second[0] + (along * s - phi[k]) * third[0],
                              along * second[1] + (along * s - phi[k]) * third[1]};
        lift.mean += weight * phi[k];
        lift.first += weight * s * phi[k];
        lift.gradient_squared +=
            weight * area * (gradient[0] * gradient[0] + gradient[1] * gradient[1]);
      }
    }
    result.push_back(lift);
  }
  return result;
}

}  // namespace anticrack::estimate
