// SPDX-License-Identifier: GPL-3.0-or-later
//
// Pictures of a sweep. For the sources of this folder only.
#pragma once

#include <string>
#include <vector>

#include "figures/canvas.hpp"
#include "figures/drawing.hpp"
#include "figures/sweep_layers.hpp"
#include "results/result.hpp"

namespace anticrack::figures {

/// A of every inclusion above, contact length below, over the axis.
std::string sweep_script(const results::Result& result, const SweepAxis& axis,
                         const std::vector<Output>& outputs);

/// Where the cracks of one interface are closed, over the axis.
std::string contact_script(const results::Result& result, const SweepAxis& axis,
                           const ContactMap& map, const std::vector<Output>& outputs);

/// Draws "sweep" and, for each interface with cracks, "sweep-contact"; what is left out is noted.
void draw_sweep(const results::Result& result, Drawing& drawing);

}  // namespace anticrack::figures
