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

/// Numbers of a row in SweepColumns::slope.
std::size_t slopes(const SweepColumns& rows) {
  return rows.slope.empty() ? 0 : 2 * rows.inclusions;
}

std::size_t bytes_of(const MatrixXd& matrix) { return sizeof(double) * at(matrix.size()); }

}  // namespace

std::vector<ddm::Terms> sweep_motions(const ddm::Skeleton& skeleton) {
  std::vector<ddm::Terms> rows;
  bool tilting = false;
  for (const ddm::RigidMotion& motion : skeleton.motions) {
    rows.push_back(motion.displacement);
    tilting = tilting || !motion.slope_x.empty();
  }
  for (std::size_t j = 0; tilting && j < skeleton.motions.size(); ++j) {
    rows.push_back(skeleton.motions[j].slope_x);
    rows.push_back(skeleton.motions[j].slope_y);
  }
  return rows;
}

SweepGeometry::SweepGeometry(const SkeletonProblem& problem)
    : length(problem.traces().pair_forces().contact_mass()) {
  const TraceProblem& traces = problem.traces();
  const ddm::Decomposition& decomposition = traces.decomposition();
  const std::vector<ddm::Terms> motions = sweep_motions(decomposition.skeleton);
  motion.resize(static_cast<Index>(motions.size()), problem.lcp().size());
  for (Index j = 0; j < motion.rows(); ++j)
    motion.row(j) = problem.response(motions[at(j)]).transpose();
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
  return bytes_of(motion) + sizeof(double) * at(length.size()) +
         nodes.capacity() * sizeof(nodes[0]) + contact.capacity() * sizeof(contact[0]);
}

std::size_t SweepLoads::bytes() const noexcept {
  return bytes_of(r) + bytes_of(magnitude) + bytes_of(motion) + bytes_of(energy);
}

SweepLoads reduce(const SkeletonProblem& problem, std::span<const CaseLoads> loads,
                  const MatrixXd& constants) {
  const ddm::Decomposition& decomposition = problem.traces().decomposition();
  const std::vector<ddm::Terms> motions = sweep_motions(decomposition.skeleton);
  const bool numbers = std::ranges::any_of(decomposition.skeleton.held,
                                           [](const ddm::Held& held) { return held.value != 0; });
  const Index contacts = problem.lcp().size(), given = static_cast<Index>(loads.size());
  const Index m = given + (numbers ? 1 : 0);
  const VectorXd no_jump = VectorXd::Zero(contacts);
  SweepLoads result{MatrixXd(contacts, m), MatrixXd(contacts, m),
                    MatrixXd(static_cast<Index>(motions.size()), m), MatrixXd::Zero(m, m)};
  MatrixXd h = MatrixXd::Zero(problem.traces().maps().unknowns(), m), w(h.rows(), m),
           forces(h.rows(), m);
  for (Index j = 0; j < m; ++j) {
    VectorXd held = VectorXd::Zero(problem.traces().maps().held_count());
    if (j < given) {
      std::vector<VectorXd> g;
      for (const ddm::CondensedLoad& load : loads[at(j)].subdomains) g.push_back(load.g);
      h.col(j) = problem.gather(g);
      held = held_values(decomposition, loads[at(j)].subdomains, false);
    } else {
      for (Index k = 0; k < held.size(); ++k) held[k] = decomposition.skeleton.held[at(k)].value;
    }
    const SkeletonProblem::Reduced reduced = problem.reduce_refined(h.col(j), held);
    w.col(j) = problem.unknowns(reduced, no_jump);
    forces.col(j) = held.size() > 0 ? problem.apply(w.col(j)) : h.col(j);
    result.r.col(j) = reduced.r;
    result.magnitude.col(j) = reduced.magnitude;
    for (Index k = 0; k < result.motion.rows(); ++k)
      result.motion(k, j) = sum_of(motions[at(k)], w.col(j));
  }
  // w'K w/2 - h'w; without held values w'K w = h'w.
  const MatrixXd work = h.transpose() * w, strain = forces.transpose() * w;
  result.energy.topLeftCorner(given, given) = constants;
  result.energy += (strain + strain.transpose()) / 4 - (work + work.transpose()) / 2;
  return result;
}

SweepSolver::SweepSolver(const SkeletonProblem& problem, const SweepGeometry& geometry,
                         const ActiveSetOptions& options, std::span<const char> start)
    : _geometry(geometry),
      _forces(problem.traces().pair_forces()),
      _lcp(problem.lcp(), options.max_steps, start, &problem.nested_start(), options.tolerance),
      _r(problem.lcp().size()),
      _magnitude(problem.lcp().size()),
      _motion(geometry.motion.rows()),
      _of_jumps(geometry.motion.rows()) {}

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
    const auto slope = rows.slope.begin() + static_cast<Index>(row * slopes(rows));
    const auto contact = rows.contact.begin() + static_cast<Index>(row * rows.contacts);
    rows.energy[row] = rows.contact_length[row] = rows.kkt[row] = 0;
    std::fill_n(displacement, rows.inclusions, 0.0);
    std::fill_n(slope, slopes(rows), 0.0);
    std::fill_n(contact, rows.contacts, std::uint8_t{0});
  }
}

bool SweepSolver::combine(const SweepLoads& loads, std::span<const double> coefficients) {
  VectorXd& c = _coefficients;
  c.setOnes(loads.r.cols());  // of the held values
  std::copy(coefficients.begin(), coefficients.end(), c.begin());
  _sizes = c.cwiseAbs();
  multiply(loads.r, c, _r);
  multiply(loads.magnitude, _sizes, _magnitude);
  multiply(loads.motion, c, _motion);
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
  for (Index i = 0; i < d.size(); ++i) energy -= _r[i] * d[i] / 2;
  for (Index i = 0; i < _geometry.length.size(); ++i)
    length += _pressed[at(i)] != 0 ? _geometry.length[i] : 0;
  for (const SweepGeometry::Implied& implied : _geometry.implied)
    length += pressed_through(implied.path, _pressed) ? implied.length : 0;
  multiply(_geometry.motion, d, _of_jumps);
  _motion += _of_jumps;
  if (!std::isfinite(energy) || !_motion.allFinite() || !lambda.allFinite()) return false;
  rows.energy[row] = energy;
  rows.contact_length[row] = length;
  rows.kkt[row] = _lcp.residual();
  const auto slope = _motion.begin() + static_cast<Index>(rows.inclusions);
  std::copy(_motion.begin(), slope, rows.displacement.data() + row * rows.inclusions);
  if (!rows.slope.empty()) std::copy(slope, _motion.end(), rows.slope.data() + row * slopes(rows));
  std::uint8_t* contact = rows.contact.data() + row * rows.contacts;
  for (std::size_t i = 0; i < rows.contacts; ++i)
    contact[i] = static_cast<std::uint8_t>(_pressed[at(_geometry.contact[i])]);
  return true;
}

}  // namespace anticrack::contact
