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

}  // namespace anticrack::mesh
