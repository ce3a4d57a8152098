// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "fem/triangle_rules.hpp"

namespace anticrack::estimate {

/// The polynomial of degree 4 through values at the five Gauss points of a line; t runs from -1/2
/// at its start to 1/2 at its end.
class EdgePolynomial {
 public:
  static constexpr std::size_t points = fem::line_5.size;
  using Values = std::array<double, points>;

  explicit EdgePolynomial(const Values& values) {
    for (std::size_t j = 0; j < points; ++j)
      for (std::size_t m = 0; m < points; ++m) _factor[m] += values[j] * basis()[j][m];
  }

  /// The value of the polynomial or of its derivative at t.
  double operator()(double t, int derivative = 0) const {
    double sum = 0;
    for (std::size_t m = points; m-- > static_cast<std::size_t>(derivative);) {
      double falling = _factor[m];
      for (int k = 0; k < derivative; ++k) falling *= static_cast<double>(m) - k;
      sum = sum * t + falling;
    }
    return sum;
  }

  /// An upper bound of |derivative| on the line, if all values are at most 1.
  static double steepest() {
    double sum = 0;
    for (const Values& one : basis())
      for (std::size_t m = 1; m < points; ++m)
        sum += static_cast<double>(m) * std::abs(one[m]) * std::pow(0.5, m - 1);
    return sum;
  }

 private:
  /// Row j: the polynomial that is 1 at point j and 0 at the others, by ascending powers of t.
  static const std::array<Values, points>& basis() {
    static const std::array<Values, points> rows = [] {
      std::array<Values, points> result{};
      const auto at = [](std::size_t i) { return fem::line_5.at[i] - 0.5; };
      for (std::size_t j = 0; j < points; ++j) {
        result[j][0] = 1;
        for (std::size_t i = 0; i < points; ++i) {
          if (i == j) continue;
          for (std::size_t m = points; m-- > 0;)
            result[j][m] =
                ((m > 0 ? result[j][m - 1] : 0) - at(i) * result[j][m]) / (at(j) - at(i));
        }
      }
      return result;
    }();
    return rows;
  }

  Values _factor{};
};

}  // namespace anticrack::estimate
