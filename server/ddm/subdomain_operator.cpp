// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/subdomain_operator.hpp"

#include <utility>

#include "base/at.hpp"
#include "ddm/elimination_order.hpp"

namespace anticrack::ddm {
namespace {

Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

std::size_t bytes_of(const Eigen::SparseMatrix<double>& matrix) {
  return at(matrix.nonZeros()) * (sizeof(double) + sizeof(int)) +
         at(matrix.cols() + 1) * sizeof(int);
}

}  // namespace

SubdomainOperator::SubdomainOperator(const Subdomain& subdomain, int threads)
    : SubdomainOperator(subdomain,
                        fem::stiffness(subdomain.part, subdomain.tension, index(subdomain.free())),
                        threads) {}

SubdomainOperator::SubdomainOperator(const Subdomain& subdomain, const fem::Stiffness& stiffness,
                                     int threads)
    : _factor(
          stiffness.free, index(subdomain.interior),
          elimination_order(stiffness.free, index(subdomain.interior), subdomain.part.xy, threads),
          threads),
      _free_dirichlet(stiffness.free_dirichlet),
      _dirichlet_dirichlet(stiffness.dirichlet),
      _floats(!subdomain.floating.empty()),
      _rigid(subdomain.rigid),
      _flexibility(std::make_unique<const base::Lazy<Flexibility>>()) {}

const Flexibility* SubdomainOperator::flexibility() const {
  return _floats ? nullptr
                 : &_flexibility->get([this] { return Flexibility(_factor.schur(), _rigid); });
}

std::vector<CondensedLoad> SubdomainOperator::condense(
    const Eigen::Ref<const Eigen::MatrixXd>& loads,
    const Eigen::Ref<const Eigen::MatrixXd>& dirichlet) const {
  const Eigen::Index free = _free_dirichlet.rows(), columns = loads.cols();
  Eigen::Index solves = columns;
  std::vector<Eigen::Index> boundary(at(columns), -1);  // per load: the extra column for g_D alone
  for (Eigen::Index j = 0; j < columns; ++j)
    boundary[at(j)] = dirichlet.col(j).isZero(0.0) ? -1 : solves++;
  const auto solved = [&] {
    if (solves == columns) return _factor.forward(loads.topRows(free));
    Eigen::MatrixXd right_hand_sides(free, solves);
    right_hand_sides.leftCols(columns) = loads.topRows(free);
    for (Eigen::Index j = 0; j < columns; ++j) {
      if (const Eigen::Index b = boundary[at(j)]; b >= 0) {
        right_hand_sides.col(b) = -(_free_dirichlet * dirichlet.col(j));
        right_hand_sides.col(j) += right_hand_sides.col(b);
      }
    }
    return _factor.forward(right_hand_sides);
  };
  std::vector<SubdomainFactor::Forward> forward = solved();
  std::vector<CondensedLoad> result(at(columns));
  for (Eigen::Index j = 0; j < columns; ++j) {
    CondensedLoad& load = result[at(j)];
    load.dirichlet = dirichlet.col(j);
    load.z_interior = std::move(forward[at(j)].z_interior);
    load.g = std::move(forward[at(j)].g);
    load.on_dirichlet = loads.col(j).tail(dirichlet.rows());
    const double interior_energy = load.z_interior.squaredNorm();
    const Eigen::Index b = boundary[at(j)];
    if (b < 0) {
      load.dirichlet_force = Eigen::VectorXd::Zero(load.dirichlet.size());
      load.g_boundary = Eigen::VectorXd::Zero(load.g.size());
      load.norm_constant = interior_energy;
      load.energy_constant = -interior_energy / 2;
      continue;
    }
    load.dirichlet_force = _dirichlet_dirichlet * load.dirichlet;
    const double boundary_energy = load.dirichlet.dot(load.dirichlet_force);
    load.z_boundary = std::move(forward[at(b)].z_interior);
    load.g_boundary = std::move(forward[at(b)].g);
    load.norm_constant =
        interior_energy - 2 * load.z_interior.dot(load.z_boundary) + boundary_energy;
    load.energy_constant =
        (boundary_energy - interior_energy) / 2 - load.on_dirichlet.dot(load.dirichlet);
  }
  return result;
}

void SubdomainOperator::recover(std::span<Solved> cases) const {
  const Eigen::Index free = _free_dirichlet.rows();
  std::vector<SubdomainFactor::Backward> columns;
  columns.reserve(cases.size());
  for (Solved& solved : cases) {
    columns.push_back({solved.load.z_interior, solved.trace, solved.u.head(free)});
    solved.u.tail(solved.load.dirichlet.size()) = solved.load.dirichlet;
  }
  _factor.recover(columns);
}

std::size_t SubdomainOperator::bytes() const noexcept {
  const Flexibility* flexibility = _flexibility->known();
  return _factor.bytes() + (flexibility != nullptr ? flexibility->bytes() : 0) +
         bytes_of(_free_dirichlet) + bytes_of(_dirichlet_dirichlet) +
         _rigid.capacity() * sizeof(std::int32_t);
}

}  // namespace anticrack::ddm
