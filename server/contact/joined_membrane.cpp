// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/joined_membrane.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include "base/at.hpp"
#include "base/at_once.hpp"
#include "ddm/elimination_order.hpp"
#include "stop/stop.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

constexpr const char* joining = "joining the sides of a mesh";

Index index(std::size_t i) { return static_cast<Index>(i); }

std::size_t bytes_of(const Sparse& matrix) {
  return at(matrix.nonZeros()) * (sizeof(double) + sizeof(int)) +
         at(matrix.cols() + 1) * sizeof(int);
}

Sparse block_of(const Sparse& matrix, Index row, Index column, Index rows, Index columns) {
  stop::look(joining);
  return matrix.block(row, column, rows, columns);
}

/// y += K x for the lower triangle of K.
void add_product(const Sparse& lower, const VectorXd& x, VectorXd& y) {
  y += lower.selfadjointView<Eigen::Lower>() * x;
}

/// The order of the first `interior` unknowns.
std::vector<std::int32_t> order_of(const std::vector<std::int32_t>& all, Index interior) {
  std::vector<std::int32_t> order;
  order.reserve(at(interior));
  std::ranges::copy_if(all, std::back_inserter(order),
                       [=](std::int32_t i) { return i < interior; });
  return order;
}

}  // namespace

JoinedMembrane::JoinedMembrane(const TraceProblem& traces, bool condense_contacts, int threads)
    : _traces(traces),
      _stiffness(decomposition().subdomains.size()),
      _matrix(assemble()),
      _a(block_of(_matrix, 0, 0, _interior + traces.maps().free_count(),
                  _interior + traces.maps().free_count())),
      _b(block_of(_matrix, _a.rows(), 0, traces.maps().jump_count(), _a.rows())),
      _d(block_of(_matrix, _a.rows(), _a.rows(), _b.rows(), _b.rows())),
      _order(ddm::elimination_order(_matrix, _a.rows() + _b.rows(), _places, threads)),
      _factor(condense_contacts
                  ? ddm::SubdomainFactor(open(), _a.rows(), order_of(_order, _a.rows()), threads)
                  : ddm::SubdomainFactor(_a, _a.rows(), order_of(_order, _a.rows()), threads)) {
  const Index held = traces.maps().held_count(), last = _a.rows() + _b.rows();
  _xp = Sparse(block_of(_matrix, last, 0, held, _a.rows()).transpose());
  _dp = Sparse(block_of(_matrix, last, _a.rows(), held, _b.rows()).transpose());
  _pp = block_of(_matrix, last, last, held, held);
}

Sparse JoinedMembrane::open() const {
  return block_of(_matrix, 0, 0, size() + contacts(), size() + contacts());
}

/// Sets _stiffness, _first, _interior and _places as well.
Sparse JoinedMembrane::assemble() {
  const ddm::Skeleton& skeleton = decomposition().skeleton;
  for (std::size_t s = 0; s < _stiffness.size(); ++s) {
    stop::look(joining);
    const ddm::Subdomain& subdomain = decomposition().subdomains[s];
    _stiffness[s] = fem::stiffness(subdomain.part, subdomain.tension, index(subdomain.free()));
    _first.push_back(_interior);
    _interior += index(subdomain.interior);
  }
  const Index x = _interior + index(skeleton.free), d = x + index(skeleton.independent);
  const Index all = d + index(skeleton.held.size());
  _places.assign(2 * at(d), 0);
  // Each value of the skeleton as a sum over the entries of [x d p].
  std::vector<ddm::Terms> made_of(skeleton.unknowns);
  for (std::size_t i = 0; i < skeleton.unknowns; ++i) {
    for (const auto& [k, factor] : skeleton.rows[i].free)
      made_of[i].push_back({static_cast<std::int32_t>(_interior) + k, factor});
    for (const auto& [k, factor] : skeleton.rows[i].jumps)
      made_of[i].push_back({static_cast<std::int32_t>(x) + k, factor});
    for (const auto& [k, factor] : skeleton.rows[i].held)
      made_of[i].push_back({static_cast<std::int32_t>(d) + k, factor});
  }
  std::vector<Eigen::Triplet<double, std::int32_t>> entries;
  std::size_t count = 0;
  for (const fem::Stiffness& stiffness : _stiffness) count += at(stiffness.free.nonZeros());
  entries.reserve(count + count / 8);
  for (std::size_t s = 0; s < _stiffness.size(); ++s) {
    const ddm::Subdomain& subdomain = decomposition().subdomains[s];
    const auto interior = static_cast<std::int32_t>(subdomain.interior);
    const auto first = static_cast<std::int32_t>(_first[s]);
    for (std::size_t i = 0; i < subdomain.free(); ++i) {
      const double* place = &subdomain.part.xy[2 * i];
      if (i < subdomain.interior) {
        std::copy_n(place, 2, &_places[2 * (at(first) + i)]);
        continue;
      }
      for (const ddm::Term& term : made_of[at(subdomain.unknown[i - subdomain.interior])])
        if (term.index < d) std::copy_n(place, 2, &_places[2 * at(term.index)]);
    }
    const auto terms_of = [&](std::int32_t node, ddm::Term& own) -> std::span<const ddm::Term> {
      own = {first + node, 1};
      if (node < interior) return {&own, 1};
      return made_of[at(subdomain.unknown[at(node - interior)])];
    };
    const Sparse& lower = _stiffness[s].free;
    for (Index column = 0; column < lower.outerSize(); ++column) {
      stop::look_at_turn<stop::quick>(at(column), joining);
      ddm::Term own_column, own_row;
      const auto columns = terms_of(static_cast<std::int32_t>(column), own_column);
      for (Sparse::InnerIterator entry(lower, column); entry; ++entry) {
        const auto rows = terms_of(static_cast<std::int32_t>(entry.row()), own_row);
        for (const ddm::Term& a : rows) {
          for (const ddm::Term& b : columns) {
            if (entry.row() == column && b.index > a.index) continue;  // met the other way round
            const double value = entry.value() * a.factor * b.factor;
            entries.emplace_back(std::max(a.index, b.index), std::min(a.index, b.index), value);
            // An entry off the diagonal of K stands for two, and both may fall on the diagonal
            // here.
            if (entry.row() != column && a.index == b.index)
              entries.emplace_back(a.index, a.index, value);
          }
        }
      }
    }
  }
  for (const ddm::RigidMotion& motion : skeleton.motions)
    for (const ddm::Terms* terms : {&motion.displacement, &motion.slope_x, &motion.slope_y})
      for (const ddm::Term& term : *terms)
        for (const ddm::Term& of : made_of[at(term.index)])
          if (of.index < x) {
            _places[2 * at(of.index)] = motion.centre[0];
            _places[2 * at(of.index) + 1] = motion.centre[1];
          }
  Sparse result(all, all);
  stop::look(joining);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

std::vector<ddm::CondensedLoad> JoinedMembrane::loads(
    std::size_t subdomain, const Eigen::Ref<const Eigen::MatrixXd>& of_nodes,
    const Eigen::Ref<const Eigen::MatrixXd>& dirichlet) const {
  const fem::Stiffness& stiffness = _stiffness[subdomain];
  const Index interior = index(decomposition().subdomains[subdomain].interior);
  const Index free = stiffness.free.rows();
  std::vector<ddm::CondensedLoad> result(at(of_nodes.cols()));
  for (Index j = 0; j < of_nodes.cols(); ++j) {
    ddm::CondensedLoad& load = result[at(j)];
    load.dirichlet = dirichlet.col(j);
    load.on_dirichlet = of_nodes.col(j).tail(dirichlet.rows());
    load.dirichlet_force = stiffness.dirichlet * load.dirichlet;
    const VectorXd of_boundary = -(stiffness.free_dirichlet * load.dirichlet);
    const VectorXd force = of_nodes.col(j).head(free) + of_boundary;
    load.z_interior = force.head(interior);
    load.g = force.tail(free - interior);
    load.g_boundary = of_boundary.tail(free - interior);
    load.norm_constant = load.dirichlet.dot(load.dirichlet_force);
    load.energy_constant = load.norm_constant / 2 - load.on_dirichlet.dot(load.dirichlet);
  }
  return result;
}

VectorXd JoinedMembrane::spread(const VectorXd& h,
                                std::span<const ddm::CondensedLoad> loads) const {
  const Maps& maps = _traces.maps();
  VectorXd force = VectorXd::Zero(_matrix.rows());
  force.segment(_interior, maps.free_count()) = maps.free().transpose() * h;
  force.segment(size(), contacts()) = -(maps.jumps().transpose() * h);
  force.tail(maps.held_count()) = maps.held().transpose() * h;
  for (std::size_t s = 0; s < loads.size(); ++s)
    force.segment(_first[s], loads[s].z_interior.size()) = loads[s].z_interior;
  return force;
}

MatrixXd JoinedMembrane::solve_once(const MatrixXd& force) const {
  MatrixXd x(force.rows(), force.cols());
  _factor.solve(force, x);
  return x;
}

VectorXd JoinedMembrane::solve_refined(const VectorXd& force) const {
  VectorXd x = solve_once(force), of_x = VectorXd::Zero(size());
  add_product(_a, x, of_x);
  x += solve_once(force - of_x);
  return x;
}

VectorXd JoinedMembrane::on_free(const VectorXd& force, const VectorXd& p) const {
  VectorXd result = force.head(size());
  if (p.size() > 0) result -= _xp * p;
  return result;
}

VectorXd JoinedMembrane::of_jumps(const VectorXd& d) const {
  return solve_once(_b.transpose() * d);
}

std::vector<double> JoinedMembrane::compliances(std::span<const ddm::Terms* const> sums) const {
  MatrixXd force = MatrixXd::Zero(_factor.interior() + _factor.trace(), index(sums.size()));
  for (Index k = 0; k < force.cols(); ++k)
    force.col(k).head(size()) = spread(_traces.maps().vector_of(*sums[at(k)])).head(size());
  std::vector<double> result;
  for (const ddm::SubdomainFactor::Forward& one : _factor.forward(force))
    result.push_back(one.z_interior.squaredNorm());
  return result;
}

Reduced JoinedMembrane::reduce(const VectorXd& force, const VectorXd& p, bool refined) const {
  Reduced result;
  result.p = p;
  result.force = on_free(force, p);
  result.r = force.segment(size(), contacts());
  result.magnitude = result.r.cwiseAbs();
  if (p.size() > 0) {
    const VectorXd of_held = _dp * p;
    result.r -= of_held;
    result.magnitude += of_held.cwiseAbs();
  }
  result.x = refined ? solve_refined(result.force) : VectorXd(solve_once(result.force));
  result.r -= _b * result.x;
  result.magnitude += _b.cwiseAbs() * result.x.cwiseAbs();
  result.size = std::max(largest(result.force), largest(result.r));
  return result;
}

VectorXd JoinedMembrane::apply(const VectorXd& d, bool refined) const {
  const VectorXd force = _b.transpose() * d;
  VectorXd result = -(_b * (refined ? solve_refined(force) : VectorXd(solve_once(force))));
  add_product(_d, d, result);
  return result;
}

VectorXd JoinedMembrane::forces_of(const VectorXd& x, const VectorXd& d) const {
  return -residual({}, x, values(x, d));
}

MatrixXd JoinedMembrane::solve(const MatrixXd& force, const MatrixXd& d) const {
  MatrixXd x = solve_once(force - _b.transpose() * d), left = force;
  for (Index k = 0; k < x.cols(); ++k) left.col(k) -= forces_of(x.col(k), d.col(k)).head(size());
  x += solve_once(left);
  return x;
}

Work JoinedMembrane::work(const VectorXd& force, const Reduced& reduced) const {
  const Index held = _pp.rows();
  Work result{VectorXd::Zero(size() + held), VectorXd(size() + held), VectorXd(size() + held)};
  result.u.head(size()) = reduced.x;
  result.load.head(size()) = force.head(size());
  result.load.tail(held) = force.tail(held);
  result.internal.head(size()) = reduced.force;
  result.internal.tail(held) = _xp.transpose() * reduced.x;
  if (reduced.p.size() > 0) {
    result.u.tail(held) = reduced.p;
    result.internal.head(size()) += _xp * reduced.p;
    VectorXd of_held = VectorXd::Zero(held);
    add_product(_pp, reduced.p, of_held);
    result.internal.tail(held) += of_held;
  }
  return result;
}

VectorXd JoinedMembrane::values(const VectorXd& x, const VectorXd& d) const {
  return _traces.maps().expand(x.tail(_traces.maps().free_count()), d, {});
}

VectorXd JoinedMembrane::field(std::size_t subdomain, const VectorXd& x, const VectorXd& w) const {
  const ddm::Subdomain& of = decomposition().subdomains[subdomain];
  VectorXd u(index(of.free()));
  u.head(index(of.interior)) = x.segment(_first[subdomain], index(of.interior));
  for (std::size_t i = 0; i < of.trace; ++i) u[index(of.interior + i)] = w[of.unknown[i]];
  return u;
}

std::vector<double> JoinedMembrane::field(const VectorXd& x, const VectorXd& d) const {
  const VectorXd w = values(x, d);
  std::vector<double> result;
  for (std::size_t s = 0; s < _stiffness.size(); ++s) {
    const VectorXd u = field(s, x, w);
    result.insert(result.end(), u.begin(), u.end());
    result.insert(result.end(), decomposition().subdomains[s].dirichlet, 0.0);
  }
  return result;
}

VectorXd JoinedMembrane::forces(std::size_t subdomain, const VectorXd& u) const {
  VectorXd result = VectorXd::Zero(u.size());
  add_product(_stiffness[subdomain].free, u, result);
  return result;
}

VectorXd JoinedMembrane::residual(std::span<const ddm::CondensedLoad> loads, const VectorXd& x,
                                  const VectorXd& w) const {
  std::vector<ddm::CondensedLoad> left(_stiffness.size());
  for (std::size_t s = 0; s < left.size(); ++s) {
    const Index interior = index(decomposition().subdomains[s].interior);
    const VectorXd force = forces(s, field(s, x, w));
    left[s].z_interior = -force.head(interior);
    left[s].g = -force.tail(force.size() - interior);
    if (loads.empty()) continue;
    left[s].z_interior += loads[s].z_interior;
    left[s].g += loads[s].g;
  }
  return spread(_traces.gather(left), left);
}

std::size_t JoinedMembrane::bytes() const noexcept {
  std::size_t bytes = _factor.bytes() + _places.capacity() * sizeof(double) +
                      _order.capacity() * sizeof(std::int32_t);
  for (const Sparse* one : {&_matrix, &_a, &_d, &_xp, &_dp, &_pp}) bytes += bytes_of(*one);
  bytes += bytes_of(_matrix) - bytes_of(_a) - bytes_of(_d);  // B
  for (const fem::Stiffness& stiffness : _stiffness)
    bytes += bytes_of(stiffness.free) + bytes_of(stiffness.free_dirichlet) +
             bytes_of(stiffness.dirichlet);
  return bytes;
}

}  // namespace anticrack::contact
