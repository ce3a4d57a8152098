// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/condensed_problem.hpp"

#include <deque>
#include <span>
#include <utility>

#include "base/at.hpp"
#include "base/at_once.hpp"
#include "contact/answer.hpp"
#include "contact/dense.hpp"
#include "errors/errors.hpp"
#include "stop/stop.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// K = sum of the Schur complements over the unknowns.
MatrixXd join(const ddm::Decomposition& decomposition,
              const std::vector<ddm::SubdomainOperator>& operators) {
  const auto n = static_cast<Index>(decomposition.skeleton.unknowns);
  MatrixXd k = MatrixXd::Zero(n, n);
  for (std::size_t s = 0; s < operators.size(); ++s) {
    const MatrixXd& schur = operators[s].factor().schur();
    const std::vector<std::int32_t>& unknown = decomposition.subdomains[s].unknown;
    for (Index j = 0; j < schur.cols(); ++j)
      for (Index i = 0; i < schur.rows(); ++i) k(unknown[at(i)], unknown[at(j)]) += schur(i, j);
  }
  return k;
}

MatrixXd factorise(MatrixXd h) {
  if (!cholesky(h)) {
    throw errors::Error(errors::Reason::numerical,
                        "the stiffness of the joined subdomains is not positive definite to "
                        "rounding; a part of the membrane is not held, the mesh has triangles that "
                        "are degenerate, or it is badly scaled");
  }
  return h;
}

}  // namespace

struct CondensedProblem::Blocks {
  MatrixXd h;
  MatrixXd w;
  MatrixXd condensed;

  Blocks(const Maps& maps, const MatrixXd& k) {
    const auto couple_jumps = [&] {
      const MatrixXd of_jumps = k * maps.jumps();
      w = maps.free().transpose() * of_jumps;
      condensed = maps.jumps().transpose() * of_jumps;
    };
    const auto factorise_free = [&] {
      const MatrixXd of_free = k * maps.free();
      h = factorise(maps.free().transpose() * of_free);
    };
    base::at_once(2, base::Threads::allowed(), [&] {
      return [&](std::size_t part) { part == 0 ? factorise_free() : couple_jumps(); };
    });
    solve_lower(h, w);
    subtract_square(w, condensed);  // C'H^-1 C
    solve_lower_transposed(h, w);
    condensed.triangularView<Eigen::StrictlyUpper>() = condensed.transpose();
  }
};

CondensedProblem::CondensedProblem(const TraceProblem& traces)
    : CondensedProblem(traces,
                       Blocks(traces.maps(), join(traces.decomposition(), traces.operators()))) {}

CondensedProblem::CondensedProblem(const TraceProblem& traces, Blocks blocks)
    : ContactProblem(traces, true),
      _h(std::move(blocks.h)),
      _closed_to_open(std::move(blocks.w)),
      _contact(std::move(blocks.condensed), traces) {}

std::vector<ddm::CondensedLoad> CondensedProblem::loads(
    std::size_t subdomain, const Eigen::Ref<const MatrixXd>& of_nodes,
    const Eigen::Ref<const MatrixXd>& dirichlet) const {
  return traces().operators()[subdomain].condense(of_nodes, dirichlet);
}

Reduced CondensedProblem::eliminate(const VectorXd& h, std::span<const ddm::CondensedLoad> loads,
                                    const VectorXd& p, bool refined) const {
  VectorXd load = h, size = h.cwiseAbs();
  Reduced result;
  if (p.size() > 0) {
    const VectorXd of_held = apply(maps().held() * p);
    load -= of_held;
    size += of_held.cwiseAbs();
    result.size = largest(of_held);
  }
  const VectorXd on_free = maps().free().transpose() * load;
  const VectorXd size_on_free = maps().free().cwiseAbs().transpose() * size;
  result.p = p;
  result.x = on_free;
  solve_lower(_h, result.x);
  solve_lower_transposed(_h, result.x);
  result.r.resize(maps().jump_count());
  multiply_transposed(_closed_to_open, on_free, result.r);
  result.r -= maps().jumps().transpose() * load;
  result.magnitude = maps().jumps().cwiseAbs().transpose() * size;
  for (Index c = 0; c < result.magnitude.size(); ++c) {
    // Column by column, since Eigen would make a copy of |W| for one product.
    result.magnitude[c] += _closed_to_open.col(c).cwiseAbs().dot(size_on_free);
  }
  if (refined) {
    // For any x the residual has the same r as h, but it is a sum of smaller terms.
    const VectorXd closed = VectorXd::Zero(result.r.size());
    Reduced correction = eliminate(h - apply(values(result.x, closed, p)), loads, {}, false);
    result.x += correction.x;
    result.r = std::move(correction.r);
  }
  return result;
}

VectorXd CondensedProblem::apply(const VectorXd& w) const {
  std::vector<VectorXd> forces = traces().scatter(w);
  for (std::size_t s = 0; s < forces.size(); ++s)
    forces[s] = traces().operators()[s].factor().apply_schur(forces[s]);
  return traces().gather(forces);
}

VectorXd CondensedProblem::response(const ddm::Terms& terms) const {
  VectorXd result = VectorXd::Zero(maps().jump_count());
  const ddm::Skeleton& skeleton = traces().decomposition().skeleton;
  for (const ddm::Term& term : terms) {
    const ddm::Row& row = skeleton.rows[at(term.index)];
    for (const auto& [q, factor] : row.free)
      result += term.factor * factor * _closed_to_open.row(q).transpose();
    for (const auto& [c, factor] : row.jumps) result[c] += term.factor * factor;
  }
  return result;
}

VectorXd CondensedProblem::solve(const Reduced& load, const VectorXd& d) const {
  VectorXd q(load.x.size());
  multiply(_closed_to_open, d, q);
  q += load.x;
  return q;
}

Work CondensedProblem::work(std::span<const ddm::CondensedLoad> loads,
                            const Reduced& reduced) const {
  VectorXd w = values(reduced.x, VectorXd::Zero(reduced.r.size()), reduced.p);
  VectorXd load = traces().gather(loads);
  VectorXd internal = reduced.p.size() > 0 ? apply(w) : load;  // = h at rest, unless p is held
  return {std::move(w), std::move(load), std::move(internal)};
}

void CondensedProblem::fill(std::span<const ddm::CondensedLoad> loads, const VectorXd& /*x*/,
                            const VectorXd& w, TraceState& state) const {
  state.trace = traces().scatter(w);
  state.flux = fluxes(traces().operators(), loads, state.trace);
}

void CondensedProblem::refine(std::span<const ddm::CondensedLoad> loads, const TraceState& state,
                              const LcpAnswer& solution, Position& position) const {
  const Reduced correction = eliminate(-traces().gather(state.flux), loads, {}, false);
  position.load.x += correction.x;
  position.d += lcp().solve_open(solution.factor, correction.r);
  position.d = position.d.cwiseMax(0.0);
  position.x = solve(position.load, position.d);
}

LcpAnswer CondensedProblem::solve_contact(const Reduced& load, const LcpOptions& options,
                                          std::span<const char> start,
                                          const OnStep& on_step) const {
  return _contact.solve(load, options, start, on_step);
}

std::vector<Opened> CondensedProblem::solve_open(const std::vector<char>& closed,
                                                 std::span<const VectorXd> r,
                                                 double /*tolerance*/) const {
  return _contact.solve_open(closed, r);
}

std::unique_ptr<RowContact> CondensedProblem::rows(const LcpOptions& options,
                                                   std::span<const char> start,
                                                   std::vector<ddm::Terms> motions,
                                                   OpenResponses* responses) const {
  MatrixXd of_jumps(static_cast<Index>(motions.size()), maps().jump_count());
  for (Index j = 0; j < of_jumps.rows(); ++j)
    of_jumps.row(j) = response(motions[at(j)]).transpose();
  return _contact.rows(options, start, std::move(of_jumps), responses);
}

void CondensedProblem::recover_fields(std::span<const SolvedCase> cases) const {
  contact::recover_fields(traces(), cases);
}

std::vector<std::vector<double>> CondensedProblem::fields_of(
    std::span<const Displaced> displaced) const {
  std::vector<ddm::CondensedLoad> none;
  for (const ddm::Subdomain& subdomain : traces().decomposition().subdomains) {
    none.emplace_back().z_interior.setZero(static_cast<Index>(subdomain.interior));
    none.back().dirichlet.setZero(static_cast<Index>(subdomain.dirichlet));
  }
  std::size_t size = 0;
  for (const ddm::Subdomain& subdomain : traces().decomposition().subdomains)
    size += subdomain.node.size();
  std::vector<std::vector<double>> fields(displaced.size(), std::vector<double>(size));
  std::deque<std::vector<VectorXd>> side_traces;
  std::vector<Recovery> cases;
  Reduced load;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    stop::look("solving for contact");
    const auto& [force, d] = displaced[f];
    if (f == 0 || force != displaced[f - 1].force)
      load = eliminate(maps().vector_of(*force), {}, {}, false);
    side_traces.push_back(traces().scatter(values(solve(load, d), d, load.p)));
    Recovery& own = cases.emplace_back(Recovery{none, {}, {}});
    for (const VectorXd& trace : side_traces.back())
      own.traces.emplace_back(trace.data(), at(trace.size()));
    std::span<double> rest = fields[f];
    for (const ddm::Subdomain& subdomain : traces().decomposition().subdomains) {
      own.u.push_back(rest.first(subdomain.node.size()));
      rest = rest.subspan(subdomain.node.size());
    }
  }
  recover(traces(), cases);
  return fields;
}

std::size_t CondensedProblem::bytes() const noexcept {
  return sizeof(double) * at(_h.size() + _closed_to_open.size()) + _contact.bytes() +
         maps().bytes();
}

}  // namespace anticrack::contact
