// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/open_factor.hpp"

#include "contact/dense.hpp"
#include "contact/dense_lcp.hpp"
#include "mesh/at.hpp"

namespace anticrack::contact {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void OpenFactor::reserve(Index contacts) {
  _closed.reserve(at(contacts));
  _nodes.reserve(at(contacts));
  _values.resize(contacts * contacts);
}

bool OpenFactor::factorise(const MatrixXd& matrix, const std::vector<char>& closed) {
  if (_closed == closed) return _regular;
  _closed = closed;
  _nodes.clear();
  for (std::size_t i = 0; i < closed.size(); ++i)
    if (closed[i] == 0) _nodes.push_back(static_cast<Index>(i));
  const auto n = static_cast<Index>(_nodes.size());
  if (_values.size() < n * n) _values.resize(n * n);
  Eigen::Map<MatrixXd> factor(_values.data(), n, n);
  for (Index j = 0; j < n; ++j) {  // the upper triangle is never read
    const double* from = matrix.col(_nodes[at(j)]).data();
    double* to = factor.col(j).data();
    for (Index i = j; i < n; ++i) to[i] = from[_nodes[at(i)]];
  }
  _regular = cholesky(factor) &&
             (n == 0 || regular_pivot(factor.diagonal().array().square().minCoeff(), n));
  return _regular;
}

VectorXd OpenFactor::solve(const VectorXd& b) const {
  VectorXd x(b.size());
  solve(b, x);
  return x;
}

void OpenFactor::solve(const VectorXd& b, VectorXd& x) const {
  const auto n = static_cast<Index>(_nodes.size());
  for (Index i = 0; i < n; ++i) x[i] = b[_nodes[at(i)]];
  const Eigen::Map<const MatrixXd> factor(_values.data(), n, n);
  solve_lower(factor, x.head(n));
  solve_lower_transposed(factor, x.head(n));
  x.tail(x.size() - n).setZero();
  for (Index i = n; i-- > 0;) {  // nodes are increasing, so nothing is overwritten before it moves
    const double value = x[i];
    x[i] = 0;
    x[_nodes[at(i)]] = value;
  }
}

}  // namespace anticrack::contact
