// SPDX-License-Identifier: GPL-3.0-or-later
//
// Pictures of a sweep, which refer to the arguments they were made of. For the sources of this
// folder only.
#pragma once

#include <string>
#include <vector>

#include "figures/canvas.hpp"
#include "figures/drawing.hpp"
#include "figures/sweep_layers.hpp"
#include "results/result.hpp"

namespace anticrack::figures {

/// A of every inclusion above, contact length below, over the axis.
Picture sweep_picture(const results::Result& result, const SweepAxis& axis);

/// Where the cracks of one interface are closed, over the axis.
Picture contact_picture(const results::Result& result, const SweepAxis& axis,
                        const ContactMap& map);

/// Draws "sweep" and, for each interface with cracks, "sweep-contact"; what is left out is noted.
void draw_sweep(const results::Result& result, Drawing& drawing);

}  // namespace anticrack::figures
