// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bounds of an expression on one triangle, proved by interval arithmetic.
#pragma once

#include <array>
#include <cmath>

#include "expression/enclosure.hpp"

namespace anticrack::fem {

using expression::Interval;

/// A triangle relative to its centroid.
struct Centred {
  double x, y;                   ///< the centroid
  std::array<double, 3> dx, dy;  ///< vectors from there to the corners
  double area;
  double reach_x, reach_y;    ///< greatest |dx| and |dy|
  double length_x, length_y;  ///< fourth roots of the means of dx^4 and dy^4
  Centred(const std::array<double, 3>& at_x, const std::array<double, 3>& at_y);
  /// Means over the triangle.
  double xx() const { return mean(dx, dx); }
  double xy() const { return mean(dx, dy); }
  double yy() const { return mean(dy, dy); }
  /// Mean of the squared distance to corner i.
  double squared_distance(std::size_t i) const {
    return xx() + yy() + dx[i] * dx[i] + dy[i] * dy[i];
  }
  double diameter() const;

 private:
  static double mean(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) / 12;
  }
};

/// A model of f whose error has a bound in the mean: |f - model| has at most the integral `radius`,
/// which may be infinite. The moments are about the centroid.
struct Modelled {
  double integral = 0, x = 0, y = 0;  ///< int of the model, and of it times dx and dy
  double radius = 0;
};

struct Enclosed {
  double integral = 0;  ///< int f is within `radius` of this; `radius` may be infinite
  double radius = 0;
  Interval values;  ///< holds the values of f
  /// Holds the values outside strips about lines where f jumps or bends, whose area is `strips`.
  Interval beside;
  double strips = 0;
  Modelled moments;
};

/// Encloses int f, the values and the moments of f on a triangle: by the mean value form, of degree
/// 3 where f is smooth and of degree 1 where it has kinks; where lines of jumps or kinks pass, by
/// straight lines in their places, with strips about these in which either side is possible; else
/// by the values alone. Rounding of the points is not enclosed: some 1e-15 of the coordinates.
Enclosed enclose(expression::Enclosure& f, const Centred& triangle);

}  // namespace anticrack::fem
