// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <span>
#include <vector>

namespace anticrack::ddm {

/// The first `interior` unknowns of a subdomain in the order in which they are eliminated soonest:
/// nested dissection (nested_dissection.hpp). On triangulations of 3 k to 250 k nodes that costs as
/// much as approximate minimum degree, and half the factorisation's operations; METIS takes seven
/// times as long for 7 % less fill. `stiffness`: its lower triangle is read, rows of a column
/// ascending; `xy`: (interior,2) row-major or longer, where the unknowns are.
std::vector<std::int32_t> elimination_order(const Eigen::SparseMatrix<double>& stiffness,
                                            Eigen::Index interior, std::span<const double> xy);

}  // namespace anticrack::ddm
