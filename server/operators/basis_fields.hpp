// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "operators/mesh_parts.hpp"

namespace anticrack::operators {

/// Hands over u of the functions that rows of a sweep are sums of, on the nodes of all subdomains
/// one after another: the response to each load with every contact closed, to a unit jump of each
/// contact, and to each of `forces` with every contact closed. O(N) each. The loads need their
/// interiors. Throws errors::Error (cancelled).
void basis_fields(const MeshOperator::Parts& parts, std::span<const LoadOnTraces> loads,
                  std::span<const ddm::Terms* const> forces,
                  const std::function<void(std::vector<double>)>& take);

}  // namespace anticrack::operators
