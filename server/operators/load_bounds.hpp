// SPDX-License-Identifier: GPL-3.0-or-later
//
// The data of a load, or of a combination of loads, from which bounds are made.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "ddm/decomposition.hpp"
#include "estimate/boundary_samples.hpp"
#include "estimate/load_balance.hpp"
#include "operators/condense_loads.hpp"

namespace anticrack::operators {

/// Memory of the field, the flux and the scratch of a load while it is bounded.
constexpr std::size_t bytes_per_triangle_and_load = 450;

/// All members are linear in the load, except the oscillation, whose bounds add up.
struct BalancedLoad {
  estimate::LoadBalance balance;
  estimate::BoundarySamples boundary;  ///< of g_D; may be empty if it is linear along edges
  bool linear_along_edges = true;      ///< whether g_D is
  std::vector<double> across_chords;   ///< estimate::slopes_across_chords of g_D
  std::string obstacle;                ///< why there are no bounds, with the cure

  /// Memory of the arrays in bytes.
  std::size_t bytes() const noexcept;
};

/// The data of one load. Throws errors::Error (expression_invalid at "boundary_value", cancelled).
BalancedLoad balanced(const LoadParts& parts, const std::vector<ddm::Subdomain>& subdomains,
                      const estimate::CutMesh& cut);

/// The data of loads to be combined; `loads` are the requests. Frees the parts of `condensed`. A
/// load whose own boundary values have no bounds is an obstacle to all its combinations, since this
/// might not be seen in a sum. Throws as `balanced` does, with the load's number.
std::vector<BalancedLoad> balanced(std::span<const fem::Load* const> loads,
                                   std::vector<LoadOnTraces>& condensed,
                                   const std::vector<ddm::Subdomain>& subdomains,
                                   const estimate::CutMesh& cut);

/// The data of sum_j c_j f_j, with the obstacles of the loads whose c_j is not 0.
BalancedLoad combine(std::span<const BalancedLoad> loads, std::span<const double> coefficients);

/// Whether loads that are combined cancel, so that rounding exceeds what bounds allow for it.
/// `parts_energy`: contact::SweepLoads::parts_energy; the others: Pi and |u|^2 of the sum.
bool cancels(double parts_energy, double energy, double norm_squared) noexcept;

}  // namespace anticrack::operators
