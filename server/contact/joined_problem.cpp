// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/joined_problem.hpp"

#include <algorithm>
#include <utility>

#include "base/at.hpp"
#include "base/at_once.hpp"
#include "contact/answer.hpp"
#include "contact/open_membrane.hpp"

namespace anticrack::contact {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

bool is_joined(const ddm::Decomposition& decomposition, std::size_t condensed_up_to) {
  return decomposition.skeleton.unknowns > condensed_up_to ||
         std::ranges::any_of(decomposition.subdomains,
                             [condensed_up_to](const ddm::Subdomain& subdomain) {
                               return subdomain.trace > condensed_up_to;
                             });
}

std::size_t dense_contacts(const TraceProblem& traces) {
  return dense_contacts(std::ranges::any_of(
      traces.chains(), [](const auto& chain) { return chain.size() > most_of_a_block; }));
}

JoinedProblem::ByBlocks::ByBlocks(const JoinedMembrane& membrane, const Conditions& conditions,
                                  int threads)
    : blocks(membrane, membrane.traces().pair_forces(), threads),
      lcp(membrane, blocks, conditions) {}

JoinedProblem::JoinedProblem(const TraceProblem& traces, int threads, std::size_t most_dense)
    : ContactProblem(traces, false),
      _membrane(traces, at(traces.maps().jump_count()) <= most_dense, threads) {
  if (_membrane.condenses_contacts())
    _dense.emplace(_membrane.take_condensed(), traces);
  else
    _by_blocks.emplace(_membrane, conditions(), threads);
}

std::vector<ddm::CondensedLoad> JoinedProblem::loads(
    std::size_t subdomain, const Eigen::Ref<const MatrixXd>& of_nodes,
    const Eigen::Ref<const MatrixXd>& dirichlet) const {
  return _membrane.loads(subdomain, of_nodes, dirichlet);
}

Reduced JoinedProblem::eliminate(const VectorXd& h, std::span<const ddm::CondensedLoad> loads,
                                 const VectorXd& p, bool refined) const {
  return _membrane.reduce(_membrane.spread(h, loads), p, refined || !_dense);
}

VectorXd JoinedProblem::solve(const Reduced& load, const VectorXd& d) const {
  return _membrane.solve(load.force, d);
}

Work JoinedProblem::work(std::span<const ddm::CondensedLoad> loads, const Reduced& reduced) const {
  return _membrane.work(_membrane.spread(traces().gather(loads), loads), reduced);
}

void JoinedProblem::fill(std::span<const ddm::CondensedLoad> loads, const VectorXd& x,
                         const VectorXd& w, TraceState& state) const {
  state.trace.clear();
  state.flux.clear();
  state.of_interiors = 0;
  for (std::size_t s = 0; s < loads.size(); ++s) {
    const Index trace = loads[s].g.size();
    const VectorXd u = _membrane.field(s, x, w), force = _membrane.forces(s, u);
    state.trace.emplace_back(u.tail(trace));
    state.flux.emplace_back(force.tail(trace) - loads[s].g);
    const auto interior = u.head(u.size() - trace);
    state.of_interiors += interior.dot(force.head(interior.size()) / 2 - loads[s].z_interior);
  }
}

void JoinedProblem::refine(std::span<const ddm::CondensedLoad> loads, const TraceState& /*state*/,
                           const LcpAnswer& solution, Position& position) const {
  auto& [load, x, d] = position;
  const VectorXd force = _membrane.residual(loads, x, values(x, d, load.p));
  const Reduced left = _membrane.reduce(force, {}, !_dense);
  const VectorXd change = _dense ? _dense->lcp().solve_open(solution.factor, left.r)
                                 : _by_blocks->lcp.solve_open(left.r, solution.closed).d;
  x += left.x - _membrane.of_jumps(change);
  d = (d + change).cwiseMax(0.0);
}

LcpAnswer JoinedProblem::solve_contact(const Reduced& load, const LcpOptions& options,
                                       std::span<const char> start, const OnStep& on_step) const {
  if (_dense) return _dense->solve(load, options, start, on_step);
  return _by_blocks->lcp.solve(load.r, load.magnitude, options, start, on_step);
}

std::vector<Opened> JoinedProblem::solve_open(const std::vector<char>& closed,
                                              std::span<const VectorXd> r, double tolerance) const {
  if (_dense) return _dense->solve_open(closed, r);
  std::vector<Opened> result(r.size());
  base::at_once(r.size(), base::Threads::allowed(), [&] {
    return [&](std::size_t k) { result[k] = _by_blocks->lcp.solve_open(r[k], closed, tolerance); };
  });
  return result;
}

namespace {

class JoinedRows final : public RowContact {
 public:
  JoinedRows(const JoinedProblem& problem, const BlockLcp& lcp, const LcpOptions& options,
             std::span<const char> start, std::vector<ddm::Terms> motions)
      : _problem(problem), _lcp(lcp), _options(options), _motions(std::move(motions)) {
    _answer.closed.assign(start.begin(), start.end());
  }

  void solve(const VectorXd& r, const VectorXd& magnitude,
             const VectorXd& /*coefficients*/) override {
    _answer = _lcp.solve(r, magnitude, _options, _answer.closed, {});
  }
  const LcpAnswer& answer() const override { return _answer; }
  void motion(VectorXd& of_jumps) const override {
    const JoinedMembrane& membrane = _problem.membrane();
    const VectorXd d = _answer.d.head(membrane.contacts());
    Reduced no_load;
    no_load.force = VectorXd::Zero(membrane.size());
    const VectorXd w = _problem.values(_problem.solve(no_load, d), d, {});
    for (std::size_t k = 0; k < _motions.size(); ++k)
      of_jumps[static_cast<Index>(k)] = sum_of(_motions[k], w);
  }

 private:
  const JoinedProblem& _problem;
  const BlockLcp& _lcp;
  const LcpOptions _options;
  const std::vector<ddm::Terms> _motions;
  LcpAnswer _answer;
};

}  // namespace

std::unique_ptr<RowContact> JoinedProblem::rows(const LcpOptions& options,
                                                std::span<const char> start,
                                                std::vector<ddm::Terms> motions,
                                                OpenResponses* responses) const {
  if (!_dense)
    return std::make_unique<JoinedRows>(*this, _by_blocks->lcp, options, start, std::move(motions));
  MatrixXd of_jumps(static_cast<Index>(motions.size()), _membrane.contacts());
  for (Index j = 0; j < of_jumps.rows(); ++j)
    of_jumps.row(j) = unit_force(motions[at(j)]).r.transpose();
  return _dense->rows(options, start, std::move(of_jumps), responses);
}

void JoinedProblem::recover_fields(std::span<const SolvedCase> cases) const {
  const ddm::Decomposition& decomposition = traces().decomposition();
  const std::vector<ddm::Contact>& contacts = decomposition.skeleton.contacts;
  const auto columns = static_cast<Index>(cases.size());
  MatrixXd forces(_membrane.size(), columns), d(_membrane.contacts(), columns);
  std::vector<VectorXd> w;
  for (Index k = 0; k < columns; ++k) {
    // The traces give the jumps, and the jumps everything else.
    const SolvedCase& one = cases[at(k)];
    w.push_back(unknowns_of(decomposition, one.answer));
    for (Index c = 0; c < d.rows(); ++c)
      d(c, k) = w.back()[contacts[at(c)].plus] - w.back()[contacts[at(c)].minus];
    forces.col(k) = _membrane.on_free(_membrane.spread(traces().gather(one.loads), one.loads),
                                      held_values(decomposition, one.loads));
  }
  const MatrixXd x = _membrane.solve(forces, d);
  for (Index k = 0; k < columns; ++k) {
    const SolvedCase& one = cases[at(k)];
    for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
      const VectorXd u = _membrane.field(s, x.col(k), w[at(k)]);
      Field field{decomposition.subdomains[s].node, std::vector<double>(u.begin(), u.end())};
      field.u.insert(field.u.end(), one.loads[s].dirichlet.begin(), one.loads[s].dirichlet.end());
      one.answer.fields.push_back(std::move(field));
    }
  }
}

std::vector<std::vector<double>> JoinedProblem::fields_of(
    std::span<const Displaced> displaced) const {
  const auto columns = static_cast<Index>(displaced.size());
  MatrixXd forces(_membrane.size(), columns), d(_membrane.contacts(), columns);
  for (Index k = 0; k < columns; ++k) {
    const Displaced& one = displaced[at(k)];
    forces.col(k) = _membrane.spread(maps().vector_of(*one.force)).head(_membrane.size());
    d.col(k) = one.d;
  }
  const MatrixXd x = _membrane.solve(forces, d);
  std::vector<std::vector<double>> fields;
  for (Index k = 0; k < columns; ++k) fields.push_back(_membrane.field(x.col(k), d.col(k)));
  return fields;
}

std::unique_ptr<const OpenMembrane> JoinedProblem::open_membrane() const {
  return std::make_unique<const OpenMembrane>(_membrane);
}

std::size_t JoinedProblem::bytes() const noexcept {
  return _membrane.bytes() + (_dense ? _dense->bytes() : _by_blocks->blocks.bytes());
}

}  // namespace anticrack::contact
