// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/contact_problem.hpp"

#include <utility>

#include "contact/open_membrane.hpp"

namespace anticrack::contact {

using Eigen::VectorXd;

ContactProblem::ContactProblem(const TraceProblem& traces, bool condensed)
    : _traces(traces),
      _conditions(traces.maps().jump_count(), traces.decomposition().skeleton.dependent,
                  traces.pair_forces().contact_mass().cwiseInverse()),
      _condensed(condensed) {}

Reduced ContactProblem::reduce(std::span<const ddm::CondensedLoad> loads, const VectorXd& p,
                               bool refined) const {
  return eliminate(_traces.gather(loads), loads, p, refined);
}

UnitForce ContactProblem::unit_force(const ddm::Terms& on) const {
  Reduced load = eliminate(maps().vector_of(on), {}, {}, false);
  const VectorXd w = values(load.x, VectorXd::Zero(load.r.size()), load.p);
  return {&on, std::move(load.r), sum_of(on, w)};
}

std::vector<double> ContactProblem::compliances(std::span<const ddm::Terms* const> sums) const {
  std::vector<double> result;
  for (const ddm::Terms* sum : sums) result.push_back(unit_force(*sum).compliance);
  return result;
}

std::unique_ptr<const OpenMembrane> ContactProblem::open_membrane() const { return nullptr; }

VectorXd ContactProblem::values(const VectorXd& x, const VectorXd& d, const VectorXd& p) const {
  return maps().expand(x.tail(maps().free_count()), d, p);
}

VectorXd ContactProblem::multipliers(const TraceState& state,
                                     const std::vector<char>& closed) const {
  return _conditions.multipliers(-(maps().jumps().transpose() * _traces.gather(state.flux)),
                                 closed);
}

}  // namespace anticrack::contact
