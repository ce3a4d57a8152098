// SPDX-License-Identifier: GPL-3.0-or-later
//
// The intensity of the singular part of u at a tip, by the dual singular function.
//
// With (s, d) along and across the course, T0 = T at the tip, and per side X = s - (T0sd/T0dd) d,
// Y = (D/T0dd) d, which turn T0 into the number D, r and theta polar coordinates of (X, Y),
// w = chi(r) s*, chi = 1 - x^3 (10 - 15 x + 6 x^2), x = r/R, u0 the value of the inclusion at X (of
// a crack: of its tip),
//
//   2 alpha N c = int f w + int (u - u0) D s* (chi'' + (1 - 2 alpha) chi'/r) dX dY
//                 + sum of lambda_a [w]_a - int (T - T0) grad u.grad w
//
// and lambda_a, what presses the faces apart in node a, is int f hat_a - a(u, hat_a) on the minus
// side. So c is linear in u and f: a sum over triangles with numbers that depend on the mesh only.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "tips/course.hpp"
#include "tips/release.hpp"
#include "tips/singular.hpp"
#include "tips/tensor.hpp"

namespace anticrack::tips {

/// X, Y of one side of a tip.
struct Flattened {
  double slant = 0;     ///< X = s - slant d
  double stretch = 1;   ///< Y = stretch d
  double root = 1;      ///< D
  Tensor tip{1, 0, 1};  ///< T0
  /// `at_tip`: T0 in coordinates along and across.
  explicit Flattened(const Tensor& at_tip);
};

class Extraction {
 public:
  /// `sides`: T0 of the minus and the plus side. The support has this radius and so many triangles.
  Extraction(const Course& course, const Singular& singular, const std::array<Tensor, 2>& sides,
             double radius, std::size_t triangles);

  /// Prepares the next triangle, on the minus (0) or plus side (1), with its tension. `jumps`: 1
  /// for corners on faces that may part.
  void add(const Corners& at, const Tensor& tension, std::size_t side,
           const std::array<bool, 3>& jumps);

  /// What triangle `cell`, in the order of add(), has in 2 alpha N c; u less its value at the tip.
  double part(std::size_t cell, const std::array<double, 3>& u, const double* force) const;
  /// What an inclusion that tilts by `slope` takes from the sum of these parts.
  double part_of_slope(const Point& slope) const { return _of_slope * dot(_course.ahead, slope); }
  std::size_t bytes() const noexcept { return _weights.capacity() * sizeof(_weights[0]); }

 private:
  struct Cutoff {
    double value, first, second;  ///< chi, chi', chi''
  };
  struct Weights {
    std::array<double, 3> u{}, force{};
  };
  Cutoff cutoff(double r) const;

  const Course _course;
  const Singular _singular;
  std::array<Flattened, 2> _sides;
  double _outer = 0, _inverse = 0;  ///< chi is 0 from this r on; 1 over it
  std::vector<Weights> _weights;
  double _of_slope = 0;
};

}  // namespace anticrack::tips
