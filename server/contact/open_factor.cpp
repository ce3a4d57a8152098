// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/open_factor.hpp"

#include "contact/dense.hpp"
#include "contact/dense_lcp.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<Index> open_nodes(const std::vector<char>& closed) {
  std::vector<Index> nodes;
  nodes.reserve(closed.size());
  for (std::size_t i = 0; i < closed.size(); ++i) {
    if (closed[i] == 0) {
      nodes.push_back(static_cast<Index>(i));
    }
  }
  return nodes;
}

}  // namespace

OpenFactor::OpenFactor(const MatrixXd& matrix, const std::vector<char>& closed)
    : _nodes(open_nodes(closed)) {
  const auto n = static_cast<Index>(_nodes.size());
  if (n == 0) {
    return;
  }
  _factor.resize(n, n);
  for (Index j = 0; j < n; ++j) {  // the upper triangle is never read
    const double* from = matrix.col(_nodes[static_cast<std::size_t>(j)]).data();
    double* to = _factor.col(j).data();
    for (Index i = j; i < n; ++i) {
      to[i] = from[_nodes[static_cast<std::size_t>(i)]];
    }
  }
  _regular = cholesky(_factor) && regular_pivot(_factor.diagonal().array().square().minCoeff(), n);
}

VectorXd OpenFactor::solve(const VectorXd& b) const {
  VectorXd x = VectorXd::Zero(b.size());
  if (!_nodes.empty()) {
    VectorXd open = b(_nodes);
    solve_lower(_factor, open);
    solve_lower_transposed(_factor, open);
    x(_nodes) = open;
  }
  return x;
}

}  // namespace anticrack::contact
