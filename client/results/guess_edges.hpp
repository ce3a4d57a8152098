// SPDX-License-Identifier: GPL-3.0-or-later
//
// For the sources of this folder only.
#pragma once

#include "results/result.hpp"

namespace anticrack::results {

/// What files of earlier clients do not say, told from what they do: the names of the inclusions
/// from the answers, the condition on an edge from those at its ends, and which inclusion an edge
/// belongs to where there is but one.
void guess_edges(Result& result);

}  // namespace anticrack::results
