// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/load_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/at.hpp"

namespace anticrack::operators {
namespace {

/// g_D in the copies of the Dirichlet boundary, 0 elsewhere.
std::vector<double> on_boundary(const LoadOnTraces& load,
                                const std::vector<ddm::Subdomain>& subdomains,
                                const estimate::CutMesh& cut) {
  std::vector<double> u(cut.at.size(), 0);
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    const Eigen::VectorXd& values = load.subdomains[s].dirichlet;
    std::copy(values.begin(), values.end(), u.data() + cut.first_copy[s] + subdomains[s].free());
  }
  return u;
}

void add(std::vector<double>& sum, const std::vector<double>& values, double factor) {
  if (sum.empty()) sum.resize(values.size(), 0);
  for (std::size_t i = 0; i < values.size(); ++i) sum[i] += factor * values[i];
}

}  // namespace

std::size_t BalancedLoad::bytes() const noexcept {
  return sizeof(double) * (balance.force.capacity() + balance.traction.capacity() +
                           balance.oscillation.capacity() + boundary.capacity());
}

std::string obstacle_of(std::span<const estimate::Lift> lifts) {
  if (std::ranges::all_of(lifts, &estimate::Lift::smooth)) return "";
  return "boundary_value jumps along an edge, or is too sharp for the mesh: make it continuous, or "
         "the mesh finer";
}

BalancedLoad balanced(const LoadParts& parts, const std::vector<ddm::Subdomain>& subdomains,
                      const estimate::CutMesh& cut) {
  BalancedLoad result;
  result.obstacle = parts.obstacle;
  if (!parts.boundary_value.empty())
    result.boundary =
        fem::values_at(estimate::lift_points(cut), parts.boundary_value, "boundary_value");
  std::vector<fem::ForceParts> force = parts.integrated;
  for (std::size_t s = 0; s < force.size(); ++s) {
    if (auto linear = fem::linear_parts(subdomains[s].part, parts.force, subdomains[s].name,
                                        {subdomains[s].node, subdomains[s].triangle}))
      force[s] = std::move(*linear);
  }
  result.balance = estimate::load_balance(cut, force, parts.traction);
  if (result.obstacle.empty() && !std::ranges::all_of(result.balance.oscillation, [](double one) {
        return std::isfinite(one);
      })) {
    result.obstacle =
        "a part of the membrane that cracks and inclusions enclose has a load that is not "
        "integrated "
        "exactly, and no bounds can be proved; give it a load that is linear there";
  }
  return result;
}

std::vector<BalancedLoad> balanced(std::span<const fem::Load* const> loads,
                                   std::vector<LoadOnTraces>& condensed,
                                   const std::vector<ddm::Subdomain>& subdomains,
                                   const estimate::CutMesh& cut) {
  const bool lifted = std::ranges::any_of(
      condensed, [](const LoadOnTraces& load) { return !load.parts.boundary_value.empty(); });
  std::vector<BalancedLoad> result;
  for (std::size_t j = 0; j < loads.size(); ++j) {
    LoadParts parts = std::exchange(condensed[j].parts, {});
    // A sum with one that is not linear needs the values of those that are.
    if (lifted) parts.boundary_value = loads[j]->boundary_value;
    try {
      BalancedLoad& one = result.emplace_back(balanced(parts, subdomains, cut));
      if (one.boundary.empty() || !one.obstacle.empty()) continue;
      one.obstacle = obstacle_of(
          estimate::lifts(cut, one.boundary, on_boundary(condensed[j], subdomains, cut)));
    } catch (errors::Error& error) {
      error.below("load_cases[" + std::to_string(j) + "]");
      throw;
    }
  }
  return result;
}

BalancedLoad combine(std::span<const BalancedLoad> loads, std::span<const double> coefficients) {
  BalancedLoad sum;
  sum.balance.force.resize(loads.front().balance.force.size(), 0);
  for (std::size_t j = 0; j < loads.size(); ++j) {
    const double c = coefficients[j];
    if (c == 0) continue;
    add(sum.balance.force, loads[j].balance.force, c);
    add(sum.balance.traction, loads[j].balance.traction, c);
    add(sum.balance.oscillation, loads[j].balance.oscillation, std::abs(c));
    add(sum.boundary, loads[j].boundary, c);
    if (sum.obstacle.empty()) sum.obstacle = loads[j].obstacle;
  }
  return sum;
}

}  // namespace anticrack::operators
