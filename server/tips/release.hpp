// SPDX-License-Identifier: GPL-3.0-or-later
//
// How fast the energy falls when a tip moves ahead, by an integral over a disc about it.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "tips/course.hpp"
#include "tips/tensor.hpp"

namespace anticrack::tips {

/// A triangle of a subdomain, by numbers of ddm::Decomposition.
struct Cell {
  std::int32_t subdomain = 0;
  std::int32_t triangle = 0;
};

/// Coordinates and gradients of the hat functions of a triangle.
struct Corners {
  std::array<Point, 3> x;
  std::array<Point, 3> hat;
  double area;
};
/// Of a counterclockwise triangle.
Corners corners_of(const std::array<Point, 3>& x);

/// The derivative of T along the course at the centre of a triangle, by differences; `radius` is
/// that of the integral. Throws errors::Error (expression_invalid).
Tensor change_of(const Law& law, const Course& course, const Corners& at, double radius);

/// The number of radii with which an integral is computed.
constexpr std::size_t radii = 3;

/// V = theta(r) t, t along the course, theta 1 up to a part of the radius and linear to 0 at it,
/// interpolated in the nodes. The radii lie in geometric progression between two. On a mesh that is
/// graded towards the tip the smallest gives the best rate, and its difference from the others is
/// more than its error.
class Moved {
 public:
  Moved(const Course& course, double outer, double inner)
      : _course(course), _radii{outer, std::sqrt(outer * inner), inner} {}

  /// Adds what a triangle has in
  ///
  ///   -dPi/da = int (T g).(DV' (g - B)) - div V (T g).g/2 - (V.grad)T g.g/2 - f V.(g - B)
  ///
  /// with g = grad u, B the slope of the inclusion (0 where it does not tilt), f by int f hat_i,
  /// and `change` the derivative of T along t.
  void add(const Corners& at, const std::array<double, 3>& u, const Tensor& tension,
           const double* force, const Point& slope, const Tensor* change,
           std::array<double, radii>& sum) const;

 private:
  const Course& _course;
  std::array<double, radii> _radii;
};

}  // namespace anticrack::tips
