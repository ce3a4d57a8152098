// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/subdomain_operator.hpp"

#include <algorithm>

#include "base/at.hpp"

namespace anticrack::ddm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

template <VectorXd CondensedLoad::*part>
Index most_rows(std::span<const CondensedLoad* const> loads) {
  Index rows = 0;
  for (const CondensedLoad* load : loads) rows = std::max(rows, (load->*part).size());
  return rows;
}

/// Rows [first, first + count) of the vectors as columns; empty vectors are zero.
template <VectorXd CondensedLoad::*part>
MatrixXd block(std::span<const CondensedLoad* const> loads, Index first, Index count) {
  MatrixXd result = MatrixXd::Zero(count, static_cast<Index>(loads.size()));
  for (Index j = 0; j < result.cols(); ++j) {
    const VectorXd& column = loads[at(j)]->*part;
    if (column.size() > 0) result.col(j) = column.segment(first, count);
  }
  return result;
}

/// a_i'b_j, shape (loads, loads), by blocks of rows: whole matrices would double the loads' memory.
template <VectorXd CondensedLoad::*a, VectorXd CondensedLoad::*b>
MatrixXd inner(std::span<const CondensedLoad* const> loads) {
  constexpr Index at_once = 2048;
  const auto m = static_cast<Index>(loads.size());
  MatrixXd result = MatrixXd::Zero(m, m);
  const Index rows = std::min(most_rows<a>(loads), most_rows<b>(loads));
  for (Index first = 0; first < rows; first += at_once) {
    const Index count = std::min(at_once, rows - first);
    const MatrixXd l = block<a>(loads, first, count), r = block<b>(loads, first, count);
    result.noalias() += l.transpose() * r;
  }
  return result;
}

MatrixXd symmetric(const MatrixXd& matrix) { return (matrix + matrix.transpose()) / 2; }

}  // namespace

LoadProducts products(std::span<const CondensedLoad* const> loads, bool condensed) {
  const MatrixXd boundary =
      inner<&CondensedLoad::dirichlet, &CondensedLoad::dirichlet_force>(loads);
  const MatrixXd work = inner<&CondensedLoad::on_dirichlet, &CondensedLoad::dirichlet>(loads);
  if (!condensed) return {symmetric(boundary / 2 - work), symmetric(boundary)};
  const MatrixXd interior = inner<&CondensedLoad::z_interior, &CondensedLoad::z_interior>(loads);
  const MatrixXd mixed = inner<&CondensedLoad::z_interior, &CondensedLoad::z_boundary>(loads);
  return {symmetric((boundary - interior) / 2 - work), symmetric(interior - 2 * mixed + boundary)};
}

CondensedLoad combine(std::span<const CondensedLoad* const> loads, const LoadProducts& products,
                      const Eigen::Ref<const VectorXd>& coefficients) {
  CondensedLoad result;
  for (Index j = 0; j < coefficients.size(); ++j) {
    const CondensedLoad& load = *loads[at(j)];
    if (j == 0) {
      result.g = result.g_boundary = VectorXd::Zero(load.g.size());
      result.dirichlet = VectorXd::Zero(load.dirichlet.size());
      result.z_interior = VectorXd::Zero(load.z_interior.size());
    }
    result.z_interior += coefficients[j] * load.z_interior;
    result.g += coefficients[j] * load.g;
    result.g_boundary += coefficients[j] * load.g_boundary;
    result.dirichlet += coefficients[j] * load.dirichlet;
  }
  result.energy_constant = coefficients.dot(products.energy * coefficients);
  result.norm_constant = coefficients.dot(products.norm * coefficients);
  return result;
}

}  // namespace anticrack::ddm
