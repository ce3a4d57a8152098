// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/sweep_solver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/at.hpp"
#include "contact/dense.hpp"
#include "contact/row_order.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// How many numbers of SweepColumns::slope a row has.
std::size_t slopes(const SweepColumns& rows) {
  return rows.slope.empty() ? 0 : 2 * rows.inclusions;
}

std::size_t bytes_of(const MatrixXd& matrix) { return sizeof(double) * at(matrix.size()); }

/// Motions of the inclusions as sums of unknowns: A of each, then, if any tilts, Bx and By of each.
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

/// Whether any inclusion is held at a given number.
bool held_by_numbers(const ddm::Skeleton& skeleton) {
  return std::ranges::any_of(skeleton.held, [](const ddm::Held& held) { return held.value != 0; });
}

/// The part of the held values p that comes from a load (g_D), or from given numbers if `numbers`.
VectorXd held_part(const ddm::Decomposition& decomposition,
                   std::span<const ddm::CondensedLoad> loads, bool numbers) {
  const std::vector<ddm::Held>& held = decomposition.skeleton.held;
  VectorXd values = VectorXd::Zero(static_cast<Index>(held.size()));
  for (std::size_t k = 0; k < held.size(); ++k) {
    const ddm::Held& one = held[k];
    if (numbers)
      values[static_cast<Index>(k)] = one.value;
    else if (one.node >= 0)
      values[static_cast<Index>(k)] = loads[at(one.subdomain)].dirichlet[one.dirichlet];
  }
  return values;
}

/// Subtracts the work of forces on held inclusions from the energy.
void take_from_holders(std::span<const CaseLoads> loads, SweepLoads& reduced) {
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const auto inclusions = static_cast<Index>(loads[i].inclusion_forces.size());
    const auto row = static_cast<Index>(i);
    for (Index j = 0; j < reduced.energy.cols(); ++j) {
      double sum = 0;
      for (Index k = 0; k < inclusions; ++k) {
        Eigen::Vector3d motion(reduced.motion(k, j), 0, 0);
        if (reduced.motion.rows() > inclusions)
          motion.tail(2) = reduced.motion.col(j).segment(inclusions + 2 * k, 2);
        sum += work(loads[i].inclusion_forces[at(k)].on_holders, motion);
      }
      reduced.energy(row, j) -= sum / 2;
      reduced.energy(j, row) -= sum / 2;
    }
  }
}

}  // namespace

SweepLoads reduce(const ContactProblem& problem, std::span<const CaseLoads> loads,
                  const MatrixXd& constants) {
  const ddm::Decomposition& decomposition = problem.traces().decomposition();
  const std::vector<ddm::Terms> motions = sweep_motions(decomposition.skeleton);
  const auto contacts = problem.conditions().contacts(), given = static_cast<Index>(loads.size());
  const Index m = given + (held_by_numbers(decomposition.skeleton) ? 1 : 0);
  const VectorXd no_jump = VectorXd::Zero(contacts);
  SweepLoads result{MatrixXd(contacts, m), MatrixXd(contacts, m),
                    MatrixXd(static_cast<Index>(motions.size()), m), MatrixXd::Zero(m, m)};
  MatrixXd u, acting, internal;
  for (Index j = 0; j < m; ++j) {
    const bool numbers = j == given;
    const auto load = numbers ? std::span<const ddm::CondensedLoad>() : loads[at(j)].subdomains;
    const Reduced reduced = problem.reduce(load, held_part(decomposition, load, numbers), true);
    const VectorXd w = problem.values(reduced.x, no_jump, reduced.p);
    const Work work = problem.work(load, reduced);
    if (j == 0)
      for (MatrixXd* all : {&u, &acting, &internal}) all->resize(work.u.size(), m);
    u.col(j) = work.u;
    acting.col(j) = work.load;
    internal.col(j) = work.internal;
    result.r.col(j) = reduced.r;
    result.magnitude.col(j) = reduced.magnitude;
    for (Index k = 0; k < result.motion.rows(); ++k)
      result.motion(k, j) = sum_of(motions[at(k)], w);
  }
  // u'K u/2 - f'u; without held values u'K u = f'u.
  const MatrixXd work = acting.transpose() * u, strain = internal.transpose() * u;
  result.energy.topLeftCorner(given, given) = constants;
  result.energy += (strain + strain.transpose()) / 4 - (work + work.transpose()) / 2;
  take_from_holders(loads, result);
  return result;
}

SweepGeometry::SweepGeometry(const TraceProblem& traces) {
  const ddm::Decomposition& decomposition = traces.decomposition();
  const std::vector<ContactLength::Node>& along = traces.contact_length().nodes();
  for (std::size_t i = 0; i < along.size(); ++i) {
    if (along[i].pair < 0) continue;
    const auto node = static_cast<std::int32_t>(i);
    if (const std::int32_t own = decomposition.pairs[at(along[i].pair)].contact; own >= 0)
      measured.push_back({node, own});
    for (const PairForces::Implied& pair : traces.pair_forces().implied())
      if (pair.pair == along[i].pair) implied.push_back({node, pair.path});
  }
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
  return measured.capacity() * sizeof(measured[0]) + nodes.capacity() * sizeof(nodes[0]) +
         contact.capacity() * sizeof(contact[0]);
}

double SweepLoads::parts_energy(std::span<const double> coefficients) const {
  VectorXd sizes = VectorXd::Ones(energy.cols());
  for (std::size_t j = 0; j < coefficients.size(); ++j)
    sizes[static_cast<Index>(j)] = std::abs(coefficients[j]);
  return sizes.dot(energy.cwiseAbs() * sizes);
}

std::size_t SweepLoads::bytes() const noexcept {
  return bytes_of(r) + bytes_of(magnitude) + bytes_of(motion) + bytes_of(energy) +
         (responses ? responses->bytes() : 0);
}

std::vector<std::size_t> solving_order(const SweepLoads& loads,
                                       std::span<const double> coefficients, std::size_t rows) {
  VectorXd weight = loads.r.colwise().stableNorm();
  if (const double most = weight.size() > 0 ? weight.maxCoeff() : 0; most > 0) weight /= most;
  MatrixXd points = MatrixXd::Ones(weight.size(), static_cast<Index>(rows));
  const std::size_t given = rows == 0 ? 0 : coefficients.size() / rows;
  for (std::size_t row = 0; row < rows; ++row)
    std::copy_n(coefficients.data() + row * given, given,
                points.col(static_cast<Index>(row)).data());
  return row_order(weight.asDiagonal() * points);
}

SweepSolver::SweepSolver(const ContactProblem& problem, const SweepGeometry& geometry,
                         const ActiveSetOptions& options, std::span<const char> start,
                         OpenResponses* responses)
    : _geometry(geometry),
      _forces(problem.traces().pair_forces()),
      _length(problem.traces().contact_length()),
      _values(_length.nodes().size()),
      _r(problem.conditions().contacts()),
      _magnitude(_r.size()) {
  std::vector<ddm::Terms> motions = sweep_motions(problem.traces().decomposition().skeleton);
  _motion.resize(static_cast<Index>(motions.size()));
  _of_jumps.resize(_motion.size());
  _contact =
      problem.rows({options.tolerance, options.max_steps}, start, std::move(motions), responses);
}

void SweepSolver::solve(const SweepLoads& loads, std::span<const double> coefficients,
                        std::size_t row, SweepColumns& rows) {
  rows.steps[row] = 0;
  bool sound = combine(loads, coefficients);
  if (sound) {
    _contact->solve(_r, _magnitude, _coefficients);
    sound = _contact->answer().status == LcpStatus::solved;
    rows.steps[row] = _contact->answer().steps;
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
  c.setOnes(loads.r.cols());  // the load of given numbers always has coefficient 1
  std::copy(coefficients.begin(), coefficients.end(), c.begin());
  _sizes = c.cwiseAbs();
  multiply(loads.r, c, _r);
  multiply(loads.magnitude, _sizes, _magnitude);
  multiply(loads.motion, c, _motion);
  _product.noalias() = loads.energy * c;
  _energy = c.dot(_product);
  return std::isfinite(_energy) && _r.allFinite() && _magnitude.allFinite();
}

double SweepSolver::contact_length() {
  const LcpAnswer& answer = _contact->answer();
  for (const auto& [node, contact] : _geometry.measured) {
    const double jump = contact < answer.d.size() ? answer.d[contact] : 0;
    _values[at(node)] = {answer.lambda[contact] / _forces.contact_mass()[contact], jump,
                         _pressed[at(contact)] != 0};
  }
  for (const SweepGeometry::Implied& implied : _geometry.implied)
    _values[at(implied.node)].pressed = pressed_through(implied.path, _pressed);
  return _length.measure(_values).length;
}

bool SweepSolver::write(std::size_t row, SweepColumns& rows) {
  const LcpAnswer& answer = _contact->answer();
  double energy = _energy;
  _pressed = answer.pressed;
  _forces.complete_contact(answer.lambda, _pressed);
  for (Index i = 0; i < _r.size(); ++i) energy -= _r[i] * answer.d[i] / 2;
  _contact->motion(_of_jumps);
  _motion += _of_jumps;
  if (!std::isfinite(energy) || !_motion.allFinite() || !answer.lambda.allFinite()) return false;
  rows.energy[row] = energy;
  rows.contact_length[row] = contact_length();
  rows.kkt[row] = answer.residual;
  const auto slope = _motion.begin() + static_cast<Index>(rows.inclusions);
  std::copy(_motion.begin(), slope, rows.displacement.data() + row * rows.inclusions);
  if (!rows.slope.empty()) std::copy(slope, _motion.end(), rows.slope.data() + row * slopes(rows));
  std::uint8_t* contact = rows.contact.data() + row * rows.contacts;
  for (std::size_t i = 0; i < rows.contacts; ++i)
    contact[i] = static_cast<std::uint8_t>(_pressed[at(_geometry.contact[i])]);
  return true;
}

}  // namespace anticrack::contact
