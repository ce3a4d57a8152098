// SPDX-License-Identifier: GPL-3.0-or-later
//
// T of -div(T grad u) = f on the triangles of a subdomain: a number, or a symmetric matrix.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "fem/triangulation.hpp"
#include "mesh/tension.hpp"

namespace anticrack::fem {

/// A map of the plane that keeps areas, x' = A x with A symmetric, after which the tension is a
/// number: int grad v.T grad u dx = tension int grad' v.grad' u dx'.
struct Isotropic {
  double xx = 1, xy = 0, yy = 1;  ///< A
  double tension = 1;             ///< sqrt(det T)

  std::array<double, 2> operator()(double x, double y) const {
    return {xx * x + xy * y, xy * x + yy * y};
  }
};

/// How T varies on a triangle about its mean T_h, as integrated, in the direction in which it
/// varies most.
struct Variation {
  double below = 1;    ///< >= sqrt(T_h / T)
  double above = 1;    ///< >= sqrt(T / T_h)
  double spread = 0;   ///< >= sqrt(mean of (T - T_h)^2 / (T T_h))
  double unknown = 0;  ///< >= |mean of T - T_h| / T_h
  /// >= |T - T_h| / sqrt(T T_h)
  double most() const { return std::max(below - 1 / below, above - 1 / above); }
};

struct Tension {
  Tension(double number = 1) : mean(number) {}  // NOLINT(google-explicit-constructor)

  double mean;  ///< for a law: mean over the subdomain and both directions
  /// (m) Txx, Txy, Tyy of a law, each the mean over the triangle. Empty: T is `mean` everywhere.
  std::vector<std::array<double, 3>> of_triangle{};
  std::vector<Variation> variation{};  ///< (m) empty: T is constant on every triangle

  /// Txx, Txy, Tyy of a triangle.
  std::array<double, 3> matrix(std::size_t triangle) const {
    return of_triangle.empty() ? std::array<double, 3>{mean, 0, mean} : of_triangle[triangle];
  }
  Isotropic isotropic(std::size_t triangle) const;
  std::size_t bytes() const noexcept;
};

/// Relative tolerance of the integral of T over a subdomain, by samples.
constexpr double tension_tolerance = 1e-10;

/// `region`: the subdomain's name, for errors. Throws errors::Error (expression_invalid at
/// "along" or "across", with the point, if T is not finite and above 0 or cannot be proved to be;
/// cancelled). O(m), with some 10 evaluations of each expression a triangle.
Tension tension(const Triangulation& part, const mesh::TensionLaw& law, const std::string& region);

/// Checks what can be checked without a mesh: syntax, symbols, lengths, constants above 0; T at a
/// point, if one is given. Throws errors::Error (expression_invalid) at "along" or "across".
void check(const mesh::TensionLaw& law, std::size_t max_expression_bytes,
           const std::array<double, 2>* point = nullptr);

}  // namespace anticrack::fem
