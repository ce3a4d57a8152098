// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/trace_problem.hpp"

#include <Eigen/SparseCholesky>

#include "contact/theta_star.hpp"
#include "fem/interface_mass.hpp"

namespace anticrack::contact {
namespace {

/// R with M = R R'; F M and R'F R have the same eigenvalues.
Eigen::SparseMatrix<double> root(const Eigen::SparseMatrix<double>& mass) {
  if (mass.rows() == 0) return {};
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>>
      cholesky(mass);
  return cholesky.matrixL();
}

Eigen::SparseMatrix<double> root(const Eigen::VectorXd& mass) {
  if (mass.size() == 0)
    return {};  // Eigen 3.4 writes through a null pointer for a diagonal of size 0
  return Eigen::SparseMatrix<double>(mass.cwiseSqrt().asDiagonal());
}

}  // namespace

TraceProblem::TraceProblem(const ddm::Decomposition& decomposition,
                           const std::vector<ddm::SubdomainOperator>& operators, bool uzawa)
    : _decomposition(decomposition),
      _operators(operators),
      _forest(decomposition.skeleton),
      _lumped(fem::lumped_mass(decomposition.edges, decomposition.pairs.size())),
      _consistent(fem::consistent_mass(decomposition.edges, decomposition.pairs.size())),
      _pair_forces(decomposition, _lumped),
      _uzawa(uzawa) {}

double TraceProblem::theta_star(Mass mass) const {
  if (!_uzawa) return 0;
  return lazy_theta_star(mass).get([this, mass] {
    return contact::theta_star(_decomposition, _operators,
                               mass == Mass::lumped ? root(_lumped) : root(_consistent));
  });
}

bool TraceProblem::knows_theta_star(Mass mass) const noexcept {
  return !_uzawa || lazy_theta_star(mass).known() != nullptr;
}

void TraceProblem::apply_mass(Mass mass, const Eigen::Ref<const Eigen::MatrixXd>& mu,
                              Eigen::Ref<Eigen::MatrixXd> force) const {
  if (mass == Mass::lumped)
    force.noalias() = _lumped.asDiagonal() * mu;
  else
    force.noalias() = _consistent * mu;
}

}  // namespace anticrack::contact
