// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/bend.hpp"

#include <algorithm>
#include <cmath>

namespace anticrack::mesh {

Point Bend::at(double u) const noexcept {
  if (u <= 0) return a;
  if (u >= 1) return b;
  if (radius > 0) {
    const double turned = angle + u * sweep;
    return {centre[0] + radius * std::cos(turned), centre[1] + radius * std::sin(turned)};
  }
  const double v = 1 - u;
  Point p{};
  for (std::size_t i = 0; i < 2; ++i) {
    p[i] =
        v * v * (1 + 2 * u) * a[i] + u * u * (1 + 2 * v) * b[i] + u * v * (v * out[i] - u * in[i]);
  }
  return p;
}

Point Bend::derivative(double u) const noexcept {
  u = std::clamp(u, 0.0, 1.0);
  if (radius > 0) {
    const double turned = angle + u * sweep;
    const double speed = radius * sweep;
    return {-speed * std::sin(turned), speed * std::cos(turned)};
  }
  Point d{};
  for (std::size_t i = 0; i < 2; ++i) {
    d[i] =
        6 * u * (1 - u) * (b[i] - a[i]) + (1 - u) * (1 - 3 * u) * out[i] + u * (3 * u - 2) * in[i];
  }
  return d;
}

std::array<ChordEdge, 2> ChordEdge::halved(std::int32_t middle) const noexcept {
  std::array<ChordEdge, 2> half{*this, *this};
  half[0].b = half[1].a = middle;
  half[0].at_b = half[1].at_a = at_middle;
  half[0].at_middle = 0.375 * at_a + 0.75 * at_middle - 0.125 * at_b;
  half[1].at_middle = 0.375 * at_b + 0.75 * at_middle - 0.125 * at_a;
  return half;
}

ChordEdge chord_edge(const BentEdge& edge, const Bend& bend, const Point& a, const Point& b) {
  const Point along{b[0] - a[0], b[1] - a[1]};
  const double length = std::hypot(along[0], along[1]);
  const auto left = [&](double u) {
    const Point p = bend.at(u);
    return (along[0] * (p[1] - a[1]) - along[1] * (p[0] - a[0])) / length;
  };
  constexpr double gauss = 0.5773502691896258;  // of two points
  double curve = 0;
  for (const double x : {-gauss, gauss}) {
    const Point d = bend.derivative(edge.middle() + 0.5 * x * (edge.to - edge.from));
    curve += 0.5 * std::abs(edge.to - edge.from) * std::hypot(d[0], d[1]);
  }
  return {edge.a,
          edge.b,
          left(edge.from),
          left(edge.middle()),
          left(edge.to),
          edge.chord > 0 ? edge.chord : length,
          curve / length - 1};
}

}  // namespace anticrack::mesh
