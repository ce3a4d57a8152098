// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "contact/joined_problem.hpp"
#include "contact/sweep_solver.hpp"
#include "mesh/at.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

class JoinedRows final : public RowContact {
 public:
  JoinedRows(const JoinedProblem& problem, const ActiveSetOptions& options,
             std::span<const char> start)
      : _problem(problem),
        _options{options.tolerance, options.max_steps},
        _motions(sweep_motions(problem.traces().decomposition().skeleton)) {
    _answer.closed.assign(start.begin(), start.end());
  }

  LcpStatus solve(const VectorXd& r, const VectorXd& magnitude) override {
    _answer = _problem.lcp().solve(r, magnitude, _options, _answer.closed,
                                   [](const LcpStep&) { return true; });
    return _answer.status;
  }
  const VectorXd& d() const override { return _answer.d; }
  const VectorXd& lambda() const override { return _answer.lambda; }
  const std::vector<char>& pressed() const override { return _answer.pressed; }
  const std::vector<char>& closed() const override { return _answer.closed; }
  double residual() const override { return _answer.residual; }
  int steps() const override { return _answer.steps; }
  void motion(VectorXd& of_jumps) const override {
    const JoinedMembrane& membrane = _problem.membrane();
    JoinedMembrane::Reduced no_load;
    no_load.force = VectorXd::Zero(membrane.size());
    no_load.p = VectorXd::Zero(static_cast<Index>(membrane.decomposition().skeleton.held.size()));
    const VectorXd w = membrane.values(no_load, membrane.solve(no_load, _answer.d), _answer.d);
    for (std::size_t k = 0; k < _motions.size(); ++k)
      of_jumps[static_cast<Index>(k)] = sum_of(_motions[k], w);
  }

 private:
  const JoinedProblem& _problem;
  LcpOptions _options;
  std::vector<ddm::Terms> _motions;
  BlockLcp::Answer _answer;
};

}  // namespace

std::unique_ptr<RowContact> rows_of(const JoinedProblem& problem, const ActiveSetOptions& options,
                                    std::span<const char> start) {
  return std::make_unique<JoinedRows>(problem, options, start);
}

SweepLoads reduce(const JoinedProblem& problem, std::span<const CaseLoads> loads,
                  const MatrixXd& constants) {
  const JoinedMembrane& membrane = problem.membrane();
  const ddm::Decomposition& decomposition = membrane.decomposition();
  const std::vector<ddm::Terms> motions = sweep_motions(decomposition.skeleton);
  const Index given = static_cast<Index>(loads.size());
  const Index m = given + (held_by_numbers(decomposition.skeleton) ? 1 : 0);
  const std::vector<ddm::CondensedLoad> none = membrane.no_loads();
  const auto load = [&](Index j) -> std::span<const ddm::CondensedLoad> {
    return j < given ? loads[at(j)].subdomains : std::span(none);
  };
  const VectorXd no_jump = VectorXd::Zero(membrane.contacts());
  SweepLoads result{MatrixXd(no_jump.size(), m), MatrixXd(no_jump.size(), m),
                    MatrixXd(static_cast<Index>(motions.size()), m), MatrixXd::Zero(m, m)};
  std::vector<JoinedMembrane::Reduced> reduced;
  for (Index j = 0; j < m; ++j) {
    reduced.push_back(membrane.reduce(load(j), held_part(decomposition, load(j), j == given)));
    const VectorXd w = membrane.values(reduced.back(), reduced.back().x, no_jump);
    result.r.col(j) = reduced.back().r;
    result.magnitude.col(j) = reduced.back().magnitude;
    for (Index k = 0; k < result.motion.rows(); ++k)
      result.motion(k, j) = sum_of(motions[at(k)], w);
  }
  MatrixXd strain(m, m), work(m, m);
  for (Index i = 0; i < m; ++i) {
    for (Index j = 0; j < m; ++j) {
      strain(i, j) = membrane.work(reduced[at(i)], reduced[at(j)]);
      work(i, j) = membrane.work(load(i), reduced[at(j)]);
    }
  }
  result.energy.topLeftCorner(given, given) = constants;
  result.energy += (strain + strain.transpose()) / 4 - (work + work.transpose()) / 2;
  take_from_holders(loads, result);
  return result;
}

}  // namespace anticrack::contact
