// SPDX-License-Identifier: GPL-3.0-or-later
//
// A picture of a mesh as the server understood it: triangles and subdomains, interfaces by kind
// with their plus sides, tips, boundary conditions, and the neighbourhood of the finest tip.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "figures/canvas.hpp"
#include "figures/figures.hpp"
#include "results/mesh_plan.hpp"

namespace anticrack::figures {

/// Draws STEM.png and STEM.svg in `folder` (created if missing); STEM is `name` made safe for a
/// file name. Throws Error as `draw` does.
Drawn draw_mesh(const results::MeshPlan& plan, const std::string& name,
                const std::filesystem::path& folder, const Options& options = {});

/// That picture, a pure function of the mesh; adds to `notes` what is left out.
Picture mesh_picture(const results::MeshPlan& plan, std::vector<std::string>& notes);

}  // namespace anticrack::figures
