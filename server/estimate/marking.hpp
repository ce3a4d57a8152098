// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which triangles of a mesh to bisect, and how often, from the parts that they have in the square
// of the error.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace anticrack::estimate {

/// How often to bisect each triangle so that the sum of the indicators falls by `reduction` > 1 at
/// most (and less where the solution is singular), shape (m).
///
/// Two bisections of a triangle in which the solution is smooth leave a quarter of its indicator,
/// so n pieces of it leave 1/n. The fewest triangles have equal indicators eta_K^2 / n_K^2 = tau
/// where they are cut, n_K > 1; tau follows from what is to be left, and the levels are log2(n_K).
/// This takes a few meshes where marking by Doerfler takes one for every half; what that would mark
/// (the largest indicators, a half of their sum) is bisected at least once here too, so that its
/// convergence holds. O(m log m).
std::vector<std::uint8_t> levels(std::span<const double> indicator, double reduction);

/// Triangles after these levels, without those that are bisected to conform.
double expected_triangles(std::span<const std::uint8_t> levels);

}  // namespace anticrack::estimate
