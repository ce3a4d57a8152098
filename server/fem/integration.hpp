// SPDX-License-Identifier: GPL-3.0-or-later
//
// State shared by the parts of the integration of one load.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fem/cell.hpp"
#include "fem/load_parts.hpp"
#include "fem/sampler.hpp"
#include "fem/triangle_rules.hpp"

namespace anticrack::fem {

struct Integration {
  std::span<const double> xy;
  std::span<const std::int32_t> triangles;
  Sampler& f;
  std::span<double> load;
  double tolerance;     ///< relative
  double work;          ///< work left after the first samples, roughly in ns
  double area = 0;      ///< of all triangles
  double absolute = 0;  ///< int |f|, from the samples so far
  double settled = 0;   ///< int |f| of the parts added to the load
  double error = 0;     ///< estimated error of the parts added to the load
  bool exact = false;   ///< between switches f is a polynomial that rule_5 integrates exactly
  std::size_t cut = 0;  ///< triangles in which f jumps or bends
  ForceParts* parts = nullptr;  ///< of the size of the triangles
  bool interpolated = false;    ///< the expression takes too long for samples
  std::vector<char> curved{};   ///< (m) 1: integrated along a curve; empty: none is

  Frame frame(std::int32_t t) const { return frame_of(xy, triangles, static_cast<std::size_t>(t)); }

  /// The error that a part of a triangle may have: half of it by its area, half by its own int |f|.
  double allowed(double area_of_triangle, double share, double absolute_of_part) const {
    const double mean = area > 0 ? std::max(absolute, settled) / area : 0;
    return 0.5 * tolerance * (mean * area_of_triangle * share + absolute_of_part);
  }

  void add(std::int32_t t, const Moments& found, double found_error) {
    const auto corner = [&](std::size_t i) -> double& {
      return load[static_cast<std::size_t>(triangles[3 * static_cast<std::size_t>(t) + i])];
    };
    corner(0) += found.value[0] - found.value[1] - found.value[2];
    corner(1) += found.value[1];
    corner(2) += found.value[2];
    settled += found.absolute;
    error += found_error;
    const auto triangle = static_cast<std::size_t>(t);
    parts->load[3 * triangle] += found.value[0] - found.value[1] - found.value[2];
    parts->load[3 * triangle + 1] += found.value[1];
    parts->load[3 * triangle + 2] += found.value[2];
  }

  /// The work of some points; `each`: the work of one, in ns.
  static double price(std::size_t points, double each) {
    constexpr double overhead = 3;
    return static_cast<double>(points) * (each + overhead);
  }
  void spend(std::size_t points, double each) { work -= price(points, each); }
};

/// A triangle whose first samples do not suffice.
struct Coarse {
  std::int32_t triangle;
  Trust trust;
  Moments found;
  double error;
};

/// The number of points of the first measurement of a cell.
constexpr std::size_t points_of_cell = rule_5.size + rule_8.size;

/// Adds int f phi_i over triangles and cells without jumps to the load: by rules of degree 8 and
/// 12, then by quarters. If the work runs out, the worst cells go first. The error is estimated
/// from the convergence of the rules and, once there are quarters, from theirs, which is valid at
/// singularities too. It is infinite if the sums do not converge.
void refine_cells(Integration& integration, std::vector<Coarse> triangles, std::vector<Cell> cells);

}  // namespace anticrack::fem
