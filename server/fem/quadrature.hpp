// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

namespace anticrack::fem {

/// Point of a rule on a triangle: barycentric coordinates, weight as a part of the area.
struct QuadraturePoint {
  std::array<double, 3> barycentric;
  double weight;
};

/// Radon's rule of degree 5 (J. Radon, 1948; also Strang and Fix): all points inside.
inline const std::array<QuadraturePoint, 7>& degree_five_rule() {
  static constexpr double root = 3.872983346207416885;  // sqrt(15)
  static constexpr double a = (6 - root) / 21, b = (6 + root) / 21;
  static constexpr double wa = (155 - root) / 1200, wb = (155 + root) / 1200;
  static constexpr std::array<QuadraturePoint, 7> rule{{
      {{1.0 / 3, 1.0 / 3, 1.0 / 3}, 0.225},
      {{1 - 2 * a, a, a}, wa},
      {{a, 1 - 2 * a, a}, wa},
      {{a, a, 1 - 2 * a}, wa},
      {{1 - 2 * b, b, b}, wb},
      {{b, 1 - 2 * b, b}, wb},
      {{b, b, 1 - 2 * b}, wb},
  }};
  return rule;
}

}  // namespace anticrack::fem
