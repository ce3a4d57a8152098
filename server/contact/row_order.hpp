// SPDX-License-Identifier: GPL-3.0-or-later
//
// An order of loads in which neighbours are alike, so that each is solved from the contact of the
// one before in few steps.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace anticrack::contact {

/// The columns of `points` (loads, rows), index base 0, in an order of their directions; positive
/// multiples have the same contact, so their lengths do not count. A direction is a point on the
/// surface of the cube |x|_max = 1. The faces come one after the other, and the points of a face in
/// the order of a Hilbert curve (J. Skilling, Programming the Hilbert curve, AIP Conf. Proc. 707,
/// 2004) on a grid of 2^16 a side. Columns of one cell keep their order, and those that are 0 or
/// not finite come last. Depends on the values alone. O(loads rows log rows).
std::vector<std::size_t> row_order(const Eigen::MatrixXd& points);

}  // namespace anticrack::contact
