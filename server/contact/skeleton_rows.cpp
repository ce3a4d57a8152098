// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "contact/dense.hpp"
#include "contact/sweep_solver.hpp"
#include "mesh/at.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

class SkeletonRows final : public RowContact {
 public:
  SkeletonRows(const SkeletonProblem& problem, const ActiveSetOptions& options,
               std::span<const char> start)
      : _lcp(problem.lcp(), options.max_steps, start, &problem.nested_start(), options.tolerance) {
    const std::vector<ddm::Terms> motions =
        sweep_motions(problem.traces().decomposition().skeleton);
    _motion.resize(static_cast<Index>(motions.size()), problem.lcp().size());
    for (Index j = 0; j < _motion.rows(); ++j)
      _motion.row(j) = problem.response(motions[at(j)]).transpose();
  }

  LcpStatus solve(const VectorXd& r, const VectorXd& magnitude) override {
    return _lcp.solve(r, magnitude);
  }
  const VectorXd& d() const override { return _lcp.d(); }
  const VectorXd& lambda() const override { return _lcp.lambda(); }
  const std::vector<char>& pressed() const override { return _lcp.pressed(); }
  const std::vector<char>& closed() const override { return _lcp.closed(); }
  double residual() const override { return _lcp.residual(); }
  int steps() const override { return _lcp.steps(); }
  void motion(VectorXd& of_jumps) const override { multiply(_motion, _lcp.d(), of_jumps); }

 private:
  WarmLcp _lcp;
  MatrixXd _motion;  // (motions, d)
};

}  // namespace

std::unique_ptr<RowContact> rows_of(const SkeletonProblem& problem, const ActiveSetOptions& options,
                                    std::span<const char> start) {
  return std::make_unique<SkeletonRows>(problem, options, start);
}

SweepLoads reduce(const SkeletonProblem& problem, std::span<const CaseLoads> loads,
                  const MatrixXd& constants) {
  const ddm::Decomposition& decomposition = problem.traces().decomposition();
  const std::vector<ddm::Terms> motions = sweep_motions(decomposition.skeleton);
  const Index contacts = problem.lcp().size(), given = static_cast<Index>(loads.size());
  const Index m = given + (held_by_numbers(decomposition.skeleton) ? 1 : 0);
  const VectorXd no_jump = VectorXd::Zero(contacts);
  SweepLoads result{MatrixXd(contacts, m), MatrixXd(contacts, m),
                    MatrixXd(static_cast<Index>(motions.size()), m), MatrixXd::Zero(m, m)};
  MatrixXd h = MatrixXd::Zero(problem.traces().maps().unknowns(), m), w(h.rows(), m),
           forces(h.rows(), m);
  for (Index j = 0; j < m; ++j) {
    if (j < given) {
      std::vector<VectorXd> g;
      for (const ddm::CondensedLoad& load : loads[at(j)].subdomains) g.push_back(load.g);
      h.col(j) = problem.gather(g);
    }
    const VectorXd held = held_part(
        decomposition, j < given ? loads[at(j)].subdomains : std::span<const ddm::CondensedLoad>(),
        j == given);
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
  take_from_holders(loads, result);
  return result;
}

}  // namespace anticrack::contact
