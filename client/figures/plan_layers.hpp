// SPDX-License-Identifier: GPL-3.0-or-later
//
// The membrane from above: lines of u over the size of the flux. For the sources of this folder
// only.
#pragma once

#include <string>
#include <vector>

#include "figures/axes.hpp"
#include "figures/mesh_layers.hpp"
#include "figures/peaks.hpp"
#include "figures/surface.hpp"
#include "results/mesh_plan.hpp"

namespace anticrack::figures {

/// The mesh of a result with its interfaces, of which it keeps coordinates. O(n log k), k nodes on
/// interfaces.
results::MeshPlan plan_of(const results::Result& result);

/// |T grad u|; the colours end at 1.5 times what 98 % of the area stay below.
Peaks flux_peaks(const Surface& surface);

/// The triangles of the surface by their mean flux, from 0 to flux.shown, in `classes` of one size.
std::vector<std::vector<std::array<Spot, 3>>> flux_classes(const Surface& surface,
                                                           const Peaks& flux, std::size_t classes);

/// Where u has a level: one stretch a triangle. Of a triangle in which u is constant none.
std::vector<Stretch> contour(const Surface& surface, double level);

/// All layers of the figure, with lines at up to about `most` round values of u.
MeshLayers plan_layers(const results::Result& result, const Surface& surface, const Peaks& flux,
                       std::size_t classes, int most);

}  // namespace anticrack::figures
