// SPDX-License-Identifier: GPL-3.0-or-later
//
// A panel of a mesh's picture. For the sources of this folder only.
#pragma once

#include <string>

#include "figures/canvas.hpp"
#include "figures/mesh_layers.hpp"
#include "figures/panels.hpp"

namespace anticrack::figures {

/// The data blocks of the layers; `tag` tells those of several panels apart.
std::string mesh_data(const MeshLayers& layers, const std::string& tag);

struct MeshPanel {
  std::string tag;  ///< of its data
  Window window;
  std::string caption;
  bool with_triangles = true;
};

/// Draws the layers to one scale in both directions, in the middle of the place; `height` of the
/// picture, in widths of it.
std::string mesh_panel(const MeshLayers& layers, const MeshPanel& panel, const Place& place,
                       double height);

/// The legend of everything that some panel shows, in columns of `rows` entries.
std::string mesh_legend(const MeshLayers& layers, int rows, const Place& place);

}  // namespace anticrack::figures
