// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solutions in closed form on (-1,1) x (-1,1) with a crack on (-a,a) of the x axis, a = 1/2, f = 0
// and u prescribed on the outer boundary. All are u = Re F(z), z = x + iy, with F analytic off the
// crack, so grad u = (Re F', -Im F').
//
// Products of powers such as (z+a)^{3/4} (z-a)^{1/4} have their branch cut on the crack alone when
// each factor has its own on the negative axis and the exponents sum to an integer: left of the
// crack both turn by the same sign.
#pragma once

#include <complex>
#include <functional>
#include <numbers>
#include <string>

namespace anticrack::testing {

using Complex = std::complex<double>;

struct ExactSolution {
  std::string boundary;                        ///< g_D as an expression in x and y
  std::function<Complex(Complex)> derivative;  ///< F'
  std::function<double(double)> jump;          ///< [u] on the crack
  double displacement = 0;                     ///< A, where there is an inclusion
};

inline constexpr double crack_end = 0.5;

/// Open delaminated inclusion: F = shift - e^{i pi/4} (z+a)^{3/4} (z-a)^{1/4}. u = shift on the
/// plus side, [u] = (a+x)^{3/4} (a-x)^{1/4}: exponents 3/4 at the left and 1/4 at the right tip,
/// both of which a general solution has at either. The inclusion's resultant is zero.
inline ExactSolution open_inclusion(double shift) {
  return {std::to_string(shift) +
              " - (((x+0.5)^2 + y^2)^0.375) * (((x-0.5)^2 + y^2)^0.125)"
              " * cos(_pi/4 + 0.75*atan2(y, x+0.5) + 0.25*atan2(y, x-0.5))",
          [](Complex z) {
            const Complex left = z + crack_end, right = z - crack_end;
            return -std::polar(1.0, std::numbers::pi / 4) * std::pow(left, 0.75) *
                   std::pow(right, 0.25) * (0.75 / left + 0.25 / right);
          },
          [](double x) { return std::pow(crack_end + x, 0.75) * std::pow(crack_end - x, 0.25); },
          shift};
}

/// Open crack without inclusion: F = -i c (z^2 - a^2)^{1/2}, [u] = 2 c (a^2 - x^2)^{1/2}, stress
/// intensity factor c (pi a)^{1/2}.
inline ExactSolution open_crack(double c) {
  return {std::to_string(c) +
              " * (((x+0.5)^2 + y^2)^0.25) * (((x-0.5)^2 + y^2)^0.25)"
              " * sin(0.5*atan2(y, x+0.5) + 0.5*atan2(y, x-0.5))",
          [c](Complex z) {
            return Complex(0, -c) * z / (std::sqrt(z - crack_end) * std::sqrt(z + crack_end));
          },
          [c](double x) { return 2 * c * std::sqrt((crack_end - x) * (crack_end + x)); }};
}

/// Crack closed from tip to tip by the pressure c > 0: u = shift - c y, linear, so that every mesh
/// has it exactly.
inline ExactSolution closed_crack(double c, double shift) {
  return {std::to_string(shift) + " - " + std::to_string(c) + "*y",
          [c](Complex) { return Complex(0, c); }, [](double) { return 0.0; }, shift};
}

}  // namespace anticrack::testing
