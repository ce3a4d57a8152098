// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>

#include "fem/load.hpp"
#include "fem/triangulation.hpp"

namespace anticrack::fem {

/// b_i = int f phi_i dx for every node of a subdomain, shape (n). Constants exactly; an expression
/// by a rule of degree 5 (7 points inside each triangle), so f phi_i is integrated exactly for f of
/// degree 4, and for f that jumps across edges of the mesh only. `region` is the subdomain's name.
/// Throws errors::Error (expression_invalid) where the expression is not finite.
/// O(m), 7 evaluations a triangle.
Eigen::VectorXd load_vector(const Triangulation& part, const Force& force,
                            const std::string& region);

/// g_D at `count` nodes from number `first` on, shape (count); an empty text is 0. Throws
/// errors::Error (expression_invalid at "boundary_value").
Eigen::VectorXd boundary_values(const Triangulation& part, const std::string& text,
                                std::size_t first, std::size_t count);

}  // namespace anticrack::fem
