// SPDX-License-Identifier: GPL-3.0-or-later
//
// What Integrals of a tip are of the values that they are computed from: two are squares of them,
// one is linear.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "tips/release.hpp"

namespace anticrack::tips {

/// The integrals of a tip as forms of v: u on its `nodes`, then int f hat_i for the corners of its
/// `cells`, (3 cells). For inclusions that do not tilt.
struct Form {
  std::vector<std::pair<std::int32_t, std::int32_t>> nodes;  ///< subdomain, node of it
  std::vector<Cell> cells;
  std::array<Eigen::SparseMatrix<double>, radii> rates;  ///< v' rates v; symmetric
  Eigen::VectorXd intensity;                             ///< intensity . v
};

}  // namespace anticrack::tips
