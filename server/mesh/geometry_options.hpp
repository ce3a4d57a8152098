// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/geometry.hpp"

namespace anticrack::mesh {

/// Throws errors::Error (invalid_argument) with the field at fault, "options.size", ... unless the
/// options are those of a geometry. The points of `align` are checked with the geometry's.
void check_for_geometry(const MeshOptions& options);

}  // namespace anticrack::mesh
