// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/sweep_solver.hpp"

#include <algorithm>
#include <cmath>

#include "contact/dense.hpp"
#include "mesh/at.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::size_t bytes_of(const MatrixXd& matrix) { return sizeof(double) * at(matrix.size()); }

}  // namespace

SweepGeometry::SweepGeometry(const SkeletonProblem& problem, std::size_t inclusions)
    : displacement(static_cast<Index>(inclusions), problem.lcp().size()),
      length(VectorXd::Zero(problem.lcp().size())) {
  const TraceProblem& traces = problem.traces();
  const ddm::Decomposition& decomposition = traces.decomposition();
  for (Index j = 0; j < displacement.rows(); ++j)
    displacement.row(j) = problem.response(static_cast<std::int32_t>(j)).transpose();
  for (std::size_t i = 0; i < decomposition.pairs.size(); ++i)
    if (const std::int32_t c = decomposition.pairs[i].contact; c >= 0)
      length[c] += traces.lumped_mass()[static_cast<Index>(i)];
  for (const PairForces::Implied& pair : traces.pair_forces().implied())
    implied.push_back({pair.path, traces.lumped_mass()[pair.pair]});
  for (std::size_t c = 0; c < decomposition.interface_sides.size(); ++c) {
    const std::vector<ddm::SidePair>& sides = decomposition.interface_sides[c];
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const std::int32_t pair = sides[i].pair;
      if (pair >= 0 && decomposition.pairs[at(pair)].contact >= 0) {
        nodes.push_back({static_cast<std::int32_t>(c), static_cast<std::int32_t>(i)});
        contact.push_back(decomposition.pairs[at(pair)].contact);
      }
    }
  }
}

std::size_t SweepGeometry::bytes() const noexcept {
  return bytes_of(displacement) + sizeof(double) * at(length.size()) +
         nodes.capacity() * sizeof(nodes[0]) + contact.capacity() * sizeof(contact[0]);
}

std::size_t SweepLoads::bytes() const noexcept {
  return bytes_of(r) + bytes_of(magnitude) + bytes_of(displacement) + bytes_of(energy);
}

SweepLoads reduce(const SkeletonProblem& problem, std::size_t inclusions,
                  std::span<const CaseLoads> loads, const MatrixXd& constants) {
  const Index contacts = problem.lcp().size(), held = static_cast<Index>(inclusions);
  const auto m = static_cast<Index>(loads.size());
  const VectorXd no_jump = VectorXd::Zero(contacts);
  SweepLoads result{MatrixXd(contacts, m), MatrixXd(contacts, m), MatrixXd(held, m), constants};
  MatrixXd h(problem.traces().forest().unknowns(), m), w(h.rows(), m);
  for (Index j = 0; j < m; ++j) {
    std::vector<VectorXd> g;
    for (const ddm::CondensedLoad& load : loads[at(j)].subdomains) g.push_back(load.g);
    h.col(j) = problem.gather(g);
    const SkeletonProblem::Reduced reduced = problem.reduce_refined(h.col(j));
    w.col(j) = problem.unknowns(reduced, no_jump);
    result.r.col(j) = reduced.r;
    result.magnitude.col(j) = reduced.magnitude;
  }
  result.displacement = w.topRows(held);
  // -q'H q/2 with H q = Z'h: half the work of the loads.
  const MatrixXd work = h.transpose() * w;
  result.energy -= (work + work.transpose()) / 4;
  return result;
}

SweepSolver::SweepSolver(const SkeletonProblem& problem, const SweepGeometry& geometry,
                         const ActiveSetOptions& options, std::span<const char> start)
    : _geometry(geometry),
      _forces(problem.traces().pair_forces()),
      _lcp(problem.lcp(), options.max_steps, start, &problem.nested_start(), options.tolerance),
      _r(problem.lcp().size()),
      _magnitude(problem.lcp().size()),
      _displacement(geometry.displacement.rows()),
      _of_jumps(geometry.displacement.rows()) {}

void SweepSolver::solve(const SweepLoads& loads, std::span<const double> coefficients,
                        std::size_t row, SweepColumns& rows) {
  rows.steps[row] = 0;
  bool sound = combine(loads, coefficients);
  if (sound) {
    sound = _lcp.solve(_r, _magnitude) == LcpStatus::solved;
    rows.steps[row] = _lcp.steps();
  }
  sound = sound && write(row, rows);
  rows.status[row] = sound ? Status::converged : Status::not_converged;
  if (!sound) {
    const auto displacement = rows.displacement.begin() + static_cast<Index>(row * rows.inclusions);
    const auto contact = rows.contact.begin() + static_cast<Index>(row * rows.contacts);
    rows.energy[row] = rows.contact_length[row] = rows.kkt[row] = 0;
    std::fill_n(displacement, rows.inclusions, 0.0);
    std::fill_n(contact, rows.contacts, std::uint8_t{0});
  }
}

bool SweepSolver::combine(const SweepLoads& loads, std::span<const double> coefficients) {
  const Eigen::Map<const VectorXd> c(coefficients.data(), static_cast<Index>(coefficients.size()));
  _sizes = c.cwiseAbs();
  multiply(loads.r, c, _r);
  multiply(loads.magnitude, _sizes, _magnitude);
  multiply(loads.displacement, c, _displacement);
  _product.noalias() = loads.energy * c;
  _energy = c.dot(_product);
  return std::isfinite(_energy) && _r.allFinite() && _magnitude.allFinite();
}

bool SweepSolver::write(std::size_t row, SweepColumns& rows) {
  const VectorXd& d = _lcp.d();
  const VectorXd& lambda = _lcp.lambda();
  double energy = _energy, length = 0;
  _pressed = _lcp.pressed();
  _forces.complete_contact(lambda, _pressed);
  for (Index i = 0; i < d.size(); ++i) {
    energy -= _r[i] * d[i] / 2;
    length += _pressed[at(i)] != 0 ? _geometry.length[i] : 0;
  }
  for (const SweepGeometry::Implied& implied : _geometry.implied)
    length += pressed_through(implied.path, _pressed) ? implied.length : 0;
  multiply(_geometry.displacement, d, _of_jumps);
  _displacement += _of_jumps;
  if (!std::isfinite(energy) || !_displacement.allFinite() || !lambda.allFinite()) return false;
  rows.energy[row] = energy;
  rows.contact_length[row] = length;
  rows.kkt[row] = _lcp.residual();
  double* displacement = rows.displacement.data() + row * rows.inclusions;
  std::copy(_displacement.begin(), _displacement.end(), displacement);
  std::uint8_t* contact = rows.contact.data() + row * rows.contacts;
  for (std::size_t i = 0; i < rows.contacts; ++i)
    contact[i] = static_cast<std::uint8_t>(_pressed[at(_geometry.contact[i])]);
  return true;
}

}  // namespace anticrack::contact
