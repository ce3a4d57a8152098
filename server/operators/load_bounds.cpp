// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/load_bounds.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/at.hpp"
#include "estimate/chord_gap.hpp"

namespace anticrack::operators {
namespace {

bool is_finite(double value) { return std::isfinite(value); }

void add(std::vector<double>& sum, const std::vector<double>& values, double factor) {
  if (sum.empty()) sum.resize(values.size(), 0);
  for (std::size_t i = 0; i < values.size(); ++i) sum[i] += factor * values[i];
}

}  // namespace

std::size_t BalancedLoad::bytes() const noexcept {
  return sizeof(double) *
         (balance.force.capacity() + balance.traction.capacity() + balance.oscillation.capacity() +
          balance.moments.capacity() + boundary.values.capacity() + boundary.unknown.capacity() +
          across_chords.capacity());
}

BalancedLoad balanced(const LoadParts& parts, const std::vector<ddm::Subdomain>& subdomains,
                      const estimate::CutMesh& cut) {
  BalancedLoad result;
  result.obstacle = parts.obstacle;
  if (!parts.boundary_value.empty()) {
    result.boundary = estimate::boundary_samples(cut, parts.boundary_value);
    if (result.obstacle.empty() && !std::ranges::all_of(result.boundary.unknown, is_finite)) {
      result.obstacle =
          "boundary_value jumps along an edge, or its slope has no bound there: make it "
          "continuous, or the mesh finer";
    }
  }
  result.across_chords = estimate::slopes_across_chords(cut, parts.beside_chords);
  std::vector<double> force(cut.copy.size());
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    double* const own = force.data() + 3 * at(cut.first_triangle[s]);
    if (!fem::linear_load(subdomains[s].part, parts.force, subdomains[s].name,
                          {subdomains[s].node, subdomains[s].triangle}, [own] { return own; }))
      std::ranges::copy(parts.integrated[s].load, own);
  }
  result.balance = estimate::load_balance(cut, std::move(force), parts.integrated, parts.traction);
  if (result.obstacle.empty() && !std::ranges::all_of(result.balance.oscillation, is_finite)) {
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
    // In a sum with a g_D that is not linear along edges, the linear ones need samples as well.
    const bool linear = parts.boundary_value.empty();
    if (lifted) parts.boundary_value = loads[j]->boundary_value;
    try {
      result.push_back(balanced(parts, subdomains, cut));
      result.back().linear_along_edges = linear;
    } catch (errors::Error& error) {
      error.below(fmt::format("load_cases[{}]", j));
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
    add(sum.balance.moments, loads[j].balance.moments, std::abs(c));
    sum.balance.unknown += std::abs(c) * loads[j].balance.unknown;
    add(sum.boundary.values, loads[j].boundary.values, c);
    add(sum.boundary.unknown, loads[j].boundary.unknown, std::abs(c));
    add(sum.across_chords, loads[j].across_chords, c);
    sum.linear_along_edges = sum.linear_along_edges && loads[j].linear_along_edges;
    if (sum.obstacle.empty()) sum.obstacle = loads[j].obstacle;
  }
  if (sum.linear_along_edges) sum.boundary = {};  // rounding alone
  return sum;
}

bool cancels(double parts_energy, double energy, double norm_squared) noexcept {
  return !(parts_energy <= 1e3 * (std::abs(energy) + norm_squared));
}

}  // namespace anticrack::operators
