// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/linear_contact.hpp"

#include "stop/stop.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

VectorXd vector_of(const Maps& maps, const ddm::Terms& terms) {
  VectorXd result = VectorXd::Zero(maps.unknowns());
  for (const auto& [index, factor] : terms) result[index] += factor;
  return result;
}

SkeletonProblem::Reduced reduce(const SkeletonProblem& problem, const ddm::Terms& on) {
  const Maps& maps = problem.traces().maps();
  return problem.reduce(vector_of(maps, on), VectorXd::Zero(maps.held_count()));
}

}  // namespace

UnitForce unit_force(const SkeletonProblem& problem, const ddm::Terms& on) {
  SkeletonProblem::Reduced load = reduce(problem, on);
  const VectorXd w = problem.unknowns(load, VectorXd::Zero(load.r.size()));
  return {&on, std::move(load.r), sum_of(on, w)};
}

std::vector<Opened> solve_open(const SkeletonProblem& problem, const std::vector<char>& closed,
                               std::span<const VectorXd> r) {
  const DenseLcp& lcp = problem.lcp();
  OpenFactor own;
  if (!closed.empty()) own.factorise(lcp.scaled_matrix(), lcp.scaled_rows(), closed);
  const OpenFactor& factor = closed.empty() ? problem.all_open() : own;
  std::vector<Opened> result;
  for (const VectorXd& one : r) {
    stop::look("solving for contact");
    if (factor.regular()) {
      const VectorXd d = lcp.solve_open(factor, one);
      result.push_back({d, one - lcp.apply(d)});
    } else {
      result.push_back({VectorXd::Zero(one.size()), one, false});
    }
  }
  return result;
}

std::vector<std::vector<double>> fields_of(const SkeletonProblem& problem,
                                           std::span<const Displaced> displaced) {
  const std::vector<ddm::Subdomain>& subdomains = problem.traces().decomposition().subdomains;
  std::vector<std::vector<VectorXd>> traces;
  for (const Displaced& one : displaced) {
    stop::look("solving for contact");
    traces.push_back(problem.scatter(problem.unknowns(reduce(problem, *one.force), one.d)));
  }
  std::vector<std::vector<double>> fields(displaced.size());
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    ddm::CondensedLoad none;
    none.z_interior.setZero(static_cast<Index>(subdomains[s].interior));
    none.dirichlet.setZero(static_cast<Index>(subdomains[s].dirichlet));
    const auto count = static_cast<Index>(subdomains[s].node.size());
    std::vector<VectorXd> values(fields.size(), VectorXd(count));
    std::vector<ddm::SubdomainOperator::Solved> solved;
    for (std::size_t f = 0; f < fields.size(); ++f)
      solved.push_back({none, traces[f][s], values[f]});
    problem.traces().operators()[s].recover(solved);
    for (std::size_t f = 0; f < fields.size(); ++f)
      fields[f].insert(fields[f].end(), values[f].begin(), values[f].end());
  }
  return fields;
}

}  // namespace anticrack::contact
