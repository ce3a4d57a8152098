// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/skeleton_problem.hpp"

#include <utility>

#include "contact/dense.hpp"
#include "contact/trace_state.hpp"
#include "errors/errors.hpp"
#include "mesh/at.hpp"

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

/// Contacts in the order of the nodes of their interface; one that several interfaces share is with
/// the first of them.
std::vector<std::vector<Index>> chains(const ddm::Decomposition& decomposition) {
  std::vector<std::vector<Index>> result;
  std::vector<char> seen(decomposition.skeleton.independent, 0);
  for (const std::vector<ddm::SidePair>& sides : decomposition.interface_sides) {
    result.emplace_back();
    for (const ddm::SidePair& side : sides) {
      const std::int32_t contact = side.pair < 0 ? -1 : decomposition.pairs[at(side.pair)].contact;
      if (at(contact) >= decomposition.skeleton.independent && contact >= 0) continue;
      if (contact < 0) {  // tied: a jump of 0
        result.emplace_back();
      } else if (seen[at(contact)] == 0) {
        seen[at(contact)] = 1;
        result.back().push_back(contact);
      }
    }
  }
  return result;
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

struct SkeletonProblem::Blocks {
  MatrixXd h;
  MatrixXd w;
  MatrixXd condensed;

  Blocks(const Maps& maps, const MatrixXd& k) {
    const MatrixXd of_jumps = k * maps.jumps();
    w = maps.free().transpose() * of_jumps;
    condensed = maps.jumps().transpose() * of_jumps;
    const MatrixXd of_free = k * maps.free();
    h = factorise(maps.free().transpose() * of_free);
    solve_lower(h, w);
    subtract_square(w, condensed);  // C'H^-1 C
    solve_lower_transposed(h, w);
    condensed.triangularView<Eigen::StrictlyUpper>() = condensed.transpose();
  }
};

SkeletonProblem::SkeletonProblem(const TraceProblem& traces)
    : SkeletonProblem(traces,
                      Blocks(traces.maps(), join(traces.decomposition(), traces.operators()))) {}

SkeletonProblem::SkeletonProblem(const TraceProblem& traces, Blocks blocks)
    : _traces(traces),
      _h(std::move(blocks.h)),
      _closed_to_open(std::move(blocks.w)),
      _nested_start(blocks.condensed, chains(traces.decomposition())),
      _lcp(std::move(blocks.condensed), traces.decomposition().skeleton.dependent,
           traces.pair_forces().contact_mass().cwiseInverse()) {}

void SkeletonProblem::solve_free(VectorXd& q) const {
  solve_lower(_h, q);
  solve_lower_transposed(_h, q);
}

SkeletonProblem::Reduced SkeletonProblem::reduce(const VectorXd& h, const VectorXd& p) const {
  VectorXd load = h, size = h.cwiseAbs();
  Reduced result;
  if (p.size() > 0) {
    const VectorXd of_held = apply(maps().held() * p);
    load -= of_held;
    size += of_held.cwiseAbs();
    result.held_size = largest(of_held);
  }
  const VectorXd on_free = maps().free().transpose() * load;
  const VectorXd size_on_free = maps().free().cwiseAbs().transpose() * size;
  result.p = p;
  result.q = on_free;
  solve_free(result.q);
  result.r.resize(maps().jump_count());
  multiply_transposed(_closed_to_open, on_free, result.r);
  result.r -= maps().jumps().transpose() * load;
  result.magnitude = maps().jumps().cwiseAbs().transpose() * size;
  for (Index c = 0; c < result.magnitude.size(); ++c) {
    // One by one: Eigen would make a copy of |W| for the product.
    result.magnitude[c] += _closed_to_open.col(c).cwiseAbs().dot(size_on_free);
  }
  return result;
}

SkeletonProblem::Reduced SkeletonProblem::reduce_refined(const VectorXd& h,
                                                         const VectorXd& p) const {
  Reduced result = reduce(h, p);
  const VectorXd closed = VectorXd::Zero(maps().jump_count());
  // r of the residual is r of h, for any q, but of smaller terms.
  const Reduced correction = reduce(h - apply(maps().expand(result.q, closed, p)));
  result.q += correction.q;
  result.r = correction.r;
  return result;
}

VectorXd SkeletonProblem::apply(const VectorXd& w) const {
  std::vector<VectorXd> forces = scatter(w);
  for (std::size_t s = 0; s < forces.size(); ++s)
    forces[s] = _traces.operators()[s].factor().apply_schur(forces[s]);
  return gather(forces);
}

VectorXd SkeletonProblem::response(const ddm::Terms& terms) const {
  VectorXd result = VectorXd::Zero(maps().jump_count());
  const ddm::Skeleton& skeleton = _traces.decomposition().skeleton;
  for (const ddm::Term& term : terms) {
    const ddm::Row& row = skeleton.rows[at(term.index)];
    for (const auto& [q, factor] : row.free)
      result += term.factor * factor * _closed_to_open.row(q).transpose();
    for (const auto& [c, factor] : row.jumps) result[c] += term.factor * factor;
  }
  return result;
}

VectorXd SkeletonProblem::unknowns(const Reduced& load, const VectorXd& d) const {
  VectorXd q(load.q.size());
  multiply(_closed_to_open, d, q);
  q += load.q;
  return maps().expand(q, d, load.p);
}

void SkeletonProblem::refine(const VectorXd& residual, const OpenFactor& open, Reduced& load,
                             VectorXd& d) const {
  const Reduced correction = reduce(residual);
  load.q += correction.q;
  d += _lcp.solve_open(open, correction.r);
}

VectorXd SkeletonProblem::multipliers(const VectorXd& residual) const {
  return maps().jumps().transpose() * residual;
}

VectorXd SkeletonProblem::gather(const std::vector<VectorXd>& on_traces) const {
  VectorXd sum = VectorXd::Zero(maps().unknowns());
  for (std::size_t s = 0; s < on_traces.size(); ++s) {
    const std::vector<std::int32_t>& unknown = _traces.decomposition().subdomains[s].unknown;
    for (Index i = 0; i < on_traces[s].size(); ++i) sum[unknown[at(i)]] += on_traces[s][i];
  }
  return sum;
}

std::vector<VectorXd> SkeletonProblem::scatter(const VectorXd& w) const {
  std::vector<VectorXd> traces;
  traces.reserve(_traces.decomposition().subdomains.size());
  for (const ddm::Subdomain& subdomain : _traces.decomposition().subdomains) {
    VectorXd trace(static_cast<Index>(subdomain.trace));
    for (Index i = 0; i < trace.size(); ++i) trace[i] = w[subdomain.unknown[at(i)]];
    traces.push_back(std::move(trace));
  }
  return traces;
}

const OpenFactor& SkeletonProblem::all_open() const {
  return _all_open.get([this] {
    OpenFactor factor;
    factor.factorise(_lcp.scaled_matrix(), _lcp.scaled_rows(),
                     std::vector<char>(at(_lcp.conditions()), 0));
    return factor;
  });
}

std::size_t SkeletonProblem::bytes() const noexcept {
  const auto all_open = _all_open.known() == nullptr ? 0 : _lcp.size() * _lcp.size();
  return sizeof(double) * at(_h.size() + _closed_to_open.size() + all_open) +
         _nested_start.bytes() + _lcp.bytes() + maps().bytes();
}

}  // namespace anticrack::contact
