// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "results/result.hpp"

namespace anticrack::figures {

/// Two nodes, the lower number first.
using Edge = std::pair<std::int32_t, std::int32_t>;

/// Edges of one triangle only, the boundary of the membrane whatever holds there, in order.
/// O(m log m).
std::vector<Edge> outer_edges(const results::Mesh& mesh);

}  // namespace anticrack::figures
