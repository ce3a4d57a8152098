// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/linear_contact.hpp"

namespace anticrack::contact {

using Eigen::Index;
using Eigen::VectorXd;

UnitForce unit_force(const JoinedProblem& problem, const ddm::Terms& on) {
  JoinedMembrane::Reduced load = problem.membrane().reduce(on);
  const double compliance = load.force.dot(load.x);
  return {&on, std::move(load.r), compliance};
}

std::vector<Opened> solve_open(const JoinedProblem& problem, const std::vector<char>& closed,
                               std::span<const VectorXd> r) {
  std::vector<Opened> result;
  for (const VectorXd& one : r) {
    BlockLcp::Opened found = problem.lcp().solve_open(one, closed);
    result.push_back({std::move(found.d), std::move(found.residual), found.left <= 1e-10});
  }
  return result;
}

std::vector<std::vector<double>> fields_of(const JoinedProblem& problem,
                                           std::span<const Displaced> displaced) {
  const JoinedMembrane& membrane = problem.membrane();
  std::vector<std::vector<double>> fields;
  for (const Displaced& one : displaced) {
    const JoinedMembrane::Reduced load = membrane.force_of(*one.force);
    const VectorXd x = membrane.solve(load, one.d);
    fields.push_back(membrane.field(x, membrane.values(x, one.d)));
  }
  return fields;
}

}  // namespace anticrack::contact
