// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "fem/triangulation.hpp"

namespace anticrack::testing {

/// The unit square in 2 n^2 triangles, inner nodes moved so that no two triangles are alike.
inline fem::Triangulation crooked_square(int n) {
  fem::Triangulation part;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const bool inner = i > 0 && i < n && j > 0 && j < n;
      part.xy.push_back((i + (inner ? 0.2 * std::sin(3.0 * j + i) : 0.0)) / n);
      part.xy.push_back((j + (inner ? 0.2 * std::cos(2.0 * i + j) : 0.0)) / n);
    }
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
      part.triangles.insert(part.triangles.end(), {a, b, c, a, c, d});
    }
  }
  return part;
}

}  // namespace anticrack::testing
