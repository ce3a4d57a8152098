// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/subdomain_operator.hpp"

#include "fem/stiffness.hpp"

namespace anticrack::ddm {
namespace {

Eigen::Index index(std::size_t i) {
  return static_cast<Eigen::Index>(i);
}

std::size_t bytes_of(const Eigen::SparseMatrix<double>& matrix) {
  return static_cast<std::size_t>(matrix.nonZeros()) * (sizeof(double) + sizeof(int)) +
         static_cast<std::size_t>(matrix.cols() + 1) * sizeof(int);
}

}  // namespace

SubdomainOperator::SubdomainOperator(const Subdomain& subdomain, Ordering ordering)
    : SubdomainOperator(subdomain, fem::stiffness(subdomain.part, subdomain.tension), ordering) {}

SubdomainOperator::SubdomainOperator(const Subdomain& subdomain,
                                     const Eigen::SparseMatrix<double>& stiffness,
                                     Ordering ordering)
    : _factor(stiffness.topLeftCorner(index(subdomain.free()), index(subdomain.free())),
              index(subdomain.interior), ordering, subdomain.floating),
      _free_dirichlet(
          stiffness.topRightCorner(index(subdomain.free()), index(subdomain.dirichlet))),
      _dirichlet_dirichlet(
          stiffness.bottomRightCorner(index(subdomain.dirichlet), index(subdomain.dirichlet))) {
  if (subdomain.floating.empty()) {
    _flexibility.emplace(_factor.schur(), subdomain.rigid);
  }
}

CondensedLoad SubdomainOperator::condense(const Eigen::VectorXd& load,
                                          const Eigen::VectorXd& dirichlet) const {
  const Eigen::Index free = _free_dirichlet.rows();
  CondensedLoad result;
  result.dirichlet = dirichlet;
  if (dirichlet.isZero(0.0)) {
    SubdomainFactor::Forward forward = _factor.forward(load.head(free));
    result.z_interior = std::move(forward.z_interior);
    result.g = std::move(forward.g);
    result.g_boundary = Eigen::VectorXd::Zero(result.g.size());
    result.norm_constant = result.z_interior.squaredNorm();
    result.energy_constant = -result.norm_constant / 2;
    return result;
  }
  const Eigen::VectorXd lift = -(_free_dirichlet * dirichlet);
  const SubdomainFactor::Forward boundary = _factor.forward(lift);
  SubdomainFactor::Forward total = _factor.forward(load.head(free) + lift);
  const double boundary_energy = dirichlet.dot(_dirichlet_dirichlet * dirichlet);
  const double interior_energy = total.z_interior.squaredNorm();
  result.g_boundary = boundary.g;
  result.norm_constant =
      interior_energy - 2 * total.z_interior.dot(boundary.z_interior) + boundary_energy;
  result.energy_constant =
      (boundary_energy - interior_energy) / 2 - load.tail(dirichlet.size()).dot(dirichlet);
  result.z_interior = std::move(total.z_interior);
  result.g = std::move(total.g);
  return result;
}

Eigen::VectorXd SubdomainOperator::recover(const CondensedLoad& load,
                                           const Eigen::VectorXd& trace) const {
  Eigen::VectorXd u(_free_dirichlet.rows() + load.dirichlet.size());
  u << _factor.recover(load.z_interior, trace), load.dirichlet;
  return u;
}

std::size_t SubdomainOperator::bytes() const noexcept {
  return _factor.bytes() + (_flexibility ? _flexibility->bytes() : 0) + bytes_of(_free_dirichlet) +
         bytes_of(_dirichlet_dirichlet);
}

}  // namespace anticrack::ddm
