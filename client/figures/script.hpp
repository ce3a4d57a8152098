// SPDX-License-Identifier: GPL-3.0-or-later
//
// The gnuplot scripts of the figures, as pure functions of the result. They hold numbers, fixed
// text and strings made by `quoted`; the only file they name is the placeholder of `Output`.
#pragma once

#include <string>
#include <vector>

#include "figures/canvas.hpp"
#include "figures/surface.hpp"
#include "results/result.hpp"

namespace anticrack::figures {

/// Deformed membrane, slit open. Throws if the load has no fields.
std::string membrane_script(const results::Result& result, const results::Load& load,
                            const Surface& surface, const std::vector<Output>& outputs);

/// u-, u+ and [u] along one interface.
std::string traces_script(const results::Result& result, const results::Load& load,
                          std::size_t interface, const std::vector<Output>& outputs);

/// The criterion of step 3 of Algorithm 2 over the iterations, and epsilon.
std::string convergence_script(const results::Result& result, const results::Load& load,
                               const std::vector<Output>& outputs);

/// Membrane left, traces of the first interface right: the paper's Figures 2-5.
std::string combined_script(const results::Result& result, const results::Load& load,
                            const Surface& surface, const std::vector<Output>& outputs);

}  // namespace anticrack::figures
