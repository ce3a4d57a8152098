// SPDX-License-Identifier: GPL-3.0-or-later
//
// A panel of a mesh's picture. For the sources of this folder only.
#pragma once

#include <string>

#include "figures/mesh_layers.hpp"
#include "figures/panels.hpp"

namespace anticrack::figures {

/// The data blocks of the layers; `tag` tells those of several panels apart.
std::string mesh_data(const MeshLayers& layers, const std::string& tag);

/// Draws them under a caption (made by `quoted`), with the triangles or without.
std::string mesh_panel(const MeshLayers& layers, const std::string& tag, const Window& window,
                       const std::string& caption, bool with_triangles, const Place& place);

/// The legend of everything that some panel shows.
std::string mesh_legend(const MeshLayers& layers, const Place& place);

}  // namespace anticrack::figures
