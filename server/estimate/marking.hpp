// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tells which triangles of a mesh to bisect, and how often, from their parts in the square of the
// error.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace anticrack::estimate {

/// How often to bisect each triangle so that the sum of the indicators falls by a factor of up to
/// `reduction` > 1 (less if the solution is singular), shape (m).
///
/// If the solution is smooth in a triangle, two bisections leave a quarter of its indicator, so n
/// pieces leave 1/n of it. The number of triangles is least if all pieces of triangles that are
/// cut, n_K > 1, have equal indicators eta_K^2 / n_K^2 = tau; tau follows from the sum to be left,
/// and the levels are log2(n_K). This takes a few meshes, while Doerfler's marking takes one to
/// halve the sum. Triangles that Doerfler would mark (the largest indicators, a half of their sum)
/// are bisected at least once here too, so that his convergence holds. O(m log m).
std::vector<std::uint8_t> levels(std::span<const double> indicator, double reduction);

/// Asked of levels() at most, as a coarse mesh says little about a very fine one.
constexpr double most_reduction = 8;

/// The number of triangles after these levels, without bisections that only make the mesh conform.
double expected_triangles(std::span<const std::uint8_t> levels);

}  // namespace anticrack::estimate
