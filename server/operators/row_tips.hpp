// SPDX-License-Identifier: GPL-3.0-or-later
//
// Numbers of the tips of cracks and inclusions in the rows of a sweep. With u = sum c_j u_j + sum
// d_i u_i, u_j of load j with every contact closed and u_i of a unit jump of contact i, an energy
// release rate is a square of y = (c, d) and an intensity is linear in it, whatever is closed.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "contact/dense_lcp.hpp"
#include "contact/sweep_columns.hpp"
#include "operators/mesh_parts.hpp"
#include "tips/release.hpp"

namespace anticrack::operators {

struct RowTips {
  struct Tip {
    std::size_t index = 0;                           ///< in mesh::tips
    std::array<Eigen::MatrixXd, tips::radii> rates;  ///< (b, b), symmetric; none: it has no rate
    Eigen::VectorXd intensity;                       ///< (b)
    std::int32_t contact = -1;                       ///< of the node right behind it
  };
  std::vector<Tip> tips;
  std::vector<std::string> warnings;  ///< about tips without numbers

  std::size_t bytes() const noexcept;
};

/// Of loads condensed with their interiors and parts. O(N b), and O(b^2) for the nodes near a tip.
RowTips row_tips(const MeshOperator::Parts& parts, std::span<const LoadOnTraces> loads);

/// Fills the tips of a row that `solution` solves. O(k^2) a tip with k numbers of y that are not 0.
void find_row_tips(const MeshOperator::Parts& parts, const RowTips& shared,
                   std::span<const double> coefficients, const contact::LcpAnswer& solution,
                   std::size_t row, contact::SweepColumns& rows);

}  // namespace anticrack::operators
