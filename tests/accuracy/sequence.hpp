// SPDX-License-Identifier: GPL-3.0-or-later
//
// Load cases solved one after the other, and rates of convergence.
#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <string>

#include "contact/answer.hpp"
#include "mesh/mesh.hpp"
#include "operators/mesh_operator.hpp"

namespace anticrack::accuracy {

/// Exact contact (active set). Throws std::runtime_error where it does not converge.
contact::Answer solve(const operators::MeshOperator& op, const fem::Load& load, bool fields);

/// The same, of a load of f and g_D only.
contact::Answer solve(const operators::MeshOperator& op, const fem::Force& force,
                      const std::string& boundary = "", bool fields = false);

/// With fields and bounds.
contact::Answer solve_bounded(const operators::MeshOperator& op, const fem::Load& load);

/// `condensed_up_to`: 0 for one sparse factor (operators::MeshOperator::factorise).
std::shared_ptr<const operators::MeshOperator> factorise(
    mesh::Mesh mesh, std::size_t condensed_up_to = operators::default_condensed_up_to);

/// Order of convergence between two errors when h halves.
inline double rate(double coarse, double fine) { return std::log2(coarse / fine); }

/// What grading by m leaves of the O(h0^2) of A and of the energy (of a squared energy norm) where
/// u ~ r^{1/4}: each ring at distance r adds h^2 |D^2 u|^2 = h0^2 r^{-2m-3/2}, but rings inside
/// r = h0^{1/m}, where elements are as large as r itself, add h0^{1/(2m)} only. So the sum behaves
/// like
///
///   h0^2 (1 - h0^{(1/2 - 2m)/m}) / (1/2 - 2m)
///
/// and with m = 0.2 the bracket, 1 - h0^{1/2}, is still growing at any h0 in use: the rate seen
/// between h0 = 0.1 and 0.05 is 1.8, not 2. With m = 0.1 it is 1 - h0^3.
inline double unsaturated(double h0, double m) { return 1 - std::pow(h0, (0.5 - 2 * m) / m); }

}  // namespace anticrack::accuracy
