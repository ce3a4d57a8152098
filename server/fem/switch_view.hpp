// SPDX-License-Identifier: GPL-3.0-or-later
//
// The argument of a switch on a cell, approximated by a polynomial of degree 2 through 6 samples; a
// seventh checks it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace anticrack::fem {

/// It is sampled at the corners, the middles of the edges (i is opposite to corner i) and the
/// centroid.
inline constexpr std::size_t places = 7;
inline constexpr std::array<double, places> place_b{0, 1, 0, 0.5, 0, 0.5, 1.0 / 3};
inline constexpr std::array<double, places> place_c{0, 0, 1, 0.5, 0.5, 0, 1.0 / 3};

/// Samples are moved towards the centroid by this fraction, so that a cell with a jump along its
/// edge sees its own side only. A line within `nothing` of an edge counts as lying on it.
inline constexpr double drawn_in = 1e-12, nothing = 4e-12;

/// The odd corner by the sides of three corners, -1, 0 (on the line) or 1: the corner on the line,
/// if the line passes between the two others, else the one that is alone on its side.
inline std::size_t odd_corner(const std::array<int, 3>& side) {
  for (std::size_t k = 0; k < 3; ++k)
    if (side[k] == 0 && side[(k + 1) % 3] * side[(k + 2) % 3] < 0) return k;
  for (std::size_t k = 0; k < 3; ++k)
    if (side[k] != 0 && side[(k + 1) % 3] != side[k] && side[(k + 2) % 3] != side[k]) return k;
  return 0;
}

struct SwitchView {
  std::array<double, places> g{};
  std::array<double, 6> bernstein{};  ///< coefficients of the polynomial of degree 2
  double low = 0, high = 0;           ///< bounds of g
  double zero = 0;                    ///< smaller values are 0 to rounding
  double bent = 0;                    ///< greatest distance from a linear function

  /// `rounding`: that of coordinates, relative to the cell's size.
  SwitchView(const std::array<double, places>& values, double rounding) : g(values) {
    std::copy_n(g.begin(), 3, bernstein.begin());
    for (std::size_t i = 0; i < 3; ++i) {
      const double mean = 0.5 * (g[(i + 1) % 3] + g[(i + 2) % 3]);
      bernstein[3 + i] = 2 * g[3 + i] - mean;
      bent = std::max(bent, std::abs(bernstein[3 + i] - mean));
    }
    const auto [least, greatest] = std::minmax_element(bernstein.begin(), bernstein.end());
    zero = (nothing + 8 * rounding) * (*greatest - *least);
    const double centre = (4 * (g[3] + g[4] + g[5]) - (g[0] + g[1] + g[2])) / 9;
    const double noise = 16 * std::numeric_limits<double>::epsilon() *
                         std::max(std::abs(*least), std::abs(*greatest));
    const double off = 2 * std::max(0.0, std::abs(g[6] - centre) - zero - noise);
    bent += off;
    low = *least - off;
    high = *greatest + off;
  }

  bool straight() const { return bent <= 1e-10 * (high - low); }

  /// A value where the switch changes inside the cell, if there is one.
  std::optional<double> level(bool steps) const {
    if (!std::isfinite(low) || !std::isfinite(high)) return std::nullopt;
    if (!steps) return low < -zero && high > zero ? std::optional(0.0) : std::nullopt;
    const double first = std::floor(low + zero) + 1, last = std::ceil(high - zero) - 1;
    return first <= last ? std::optional(std::floor(0.5 * (first + last))) : std::nullopt;
  }

  /// The side of a place: -1, 0 (on the line) or 1.
  int side(std::size_t place, double level) const {
    const double off = g[place] - level;
    return std::abs(off) <= zero ? 0 : off > 0 ? 1 : -1;
  }

  /// Whether there is one line that is not too bent and crosses no edge twice.
  bool simple(double level, const std::array<int, 3>& corner_sides, bool steps) const {
    if (steps && high - low > 2) return false;
    if (bent > 0.25 * (high - low)) return false;
    const auto zeros = std::count(corner_sides.begin(), corner_sides.end(), 0);
    for (std::size_t k = 0; k < 3; ++k) {
      const int p = corner_sides[(k + 1) % 3], q = corner_sides[(k + 2) % 3];
      // No change along an edge whose ends are on the same side.
      if (p == q && p != 0 && (bernstein[3 + k] - level) * p < 0) return false;
      if (zeros == 1 && (p == 0 || q == 0) && (bernstein[3 + k] - level) * (p + q) < 0)
        return false;
    }
    if (zeros == 2) {  // a lens at the edge between the zeros, or nothing
      const std::size_t corner = odd_corner(corner_sides);
      return side(3 + corner, level) == -corner_sides[corner];
    }
    const int sum = corner_sides[0] + corner_sides[1] + corner_sides[2];
    return zeros == 0 ? std::abs(sum) == 1 : zeros == 1 && sum == 0;
  }
};

}  // namespace anticrack::fem
