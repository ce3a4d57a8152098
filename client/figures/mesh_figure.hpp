// SPDX-License-Identifier: GPL-3.0-or-later
//
// A picture of a mesh as the server understood it: triangles and subdomains, interfaces by kind
// with their plus sides, tips, what holds on the boundary, and the neighbourhood of the finest tip.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "figures/canvas.hpp"
#include "figures/figures.hpp"
#include "results/mesh_plan.hpp"

namespace anticrack::figures {

/// Draws STEM.png and STEM.svg in `folder` (made if missing), STEM being `name` made safe for a
/// file name. Throws Error as `draw` does.
Drawn draw_mesh(const results::MeshPlan& plan, const std::string& name,
                const std::filesystem::path& folder, const Options& options = {});

/// The script of that picture, a pure function of the mesh; `notes` is told what is left out.
std::string mesh_script(const results::MeshPlan& plan, const std::vector<Output>& outputs,
                        std::vector<std::string>& notes);

}  // namespace anticrack::figures
