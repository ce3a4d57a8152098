// SPDX-License-Identifier: GPL-3.0-or-later
//
// What bounds need of a load, also of a combination of loads.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "ddm/decomposition.hpp"
#include "estimate/boundary_samples.hpp"
#include "estimate/load_balance.hpp"
#include "operators/condense_loads.hpp"

namespace anticrack::operators {

/// Linear in the load but for the oscillation, whose bounds add up.
struct BalancedLoad {
  estimate::LoadBalance balance;
  estimate::BoundarySamples boundary;  ///< of g_D; empty: linear along edges
  std::string obstacle;                ///< why there are no bounds, and the cure

  /// Memory of its arrays.
  std::size_t bytes() const noexcept;
};

/// Throws errors::Error (expression_invalid at "boundary_value", cancelled).
BalancedLoad balanced(const LoadParts& parts, const std::vector<ddm::Subdomain>& subdomains,
                      const estimate::CutMesh& cut);

/// Of loads that are combined, each as it was asked for in `loads`; frees their parts. A load whose
/// own boundary values have no bounds is an obstacle to all its combinations: in a sum with others
/// that might not be seen. Throws as `balanced` does, with the load's number.
std::vector<BalancedLoad> balanced(std::span<const fem::Load* const> loads,
                                   std::vector<LoadOnTraces>& condensed,
                                   const std::vector<ddm::Subdomain>& subdomains,
                                   const estimate::CutMesh& cut);

/// sum_j c_j f_j, with the obstacles of those that are in it.
BalancedLoad combine(std::span<const BalancedLoad> loads, std::span<const double> coefficients);

}  // namespace anticrack::operators
