// SPDX-License-Identifier: GPL-3.0-or-later
//
// The checks of loads that need the geometry but no mesh.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "fem/load.hpp"
#include "mesh/geometry.hpp"

namespace anticrack::operators {

/// Whether there is a traction or boundary value: its text is neither empty nor 0.
inline bool acts(const std::string& text) { return !text.empty() && text != "0"; }

inline constexpr const char* no_boundary_value =
    "nothing has a boundary value, as all of the boundary is a Neumann boundary; leave it out, or "
    "name fewer sides in the geometry's neumann";

/// Throws errors::Error (invalid_argument) for the first load that names a region or an inclusion
/// that the geometry does not have, or that acts on nothing: a traction without a Neumann boundary,
/// a boundary value without any other, a force on an inclusion that is held, a moment on one that
/// does not tilt. The error's field is "load_cases[I].traction",
/// "load_cases[I].inclusion_forces[NAME]", ... O(n log n) for n names.
void check_loads(const std::vector<fem::Load>& loads, const mesh::Geometry& geometry);

/// The same for a mesh from a file, of which only the motions of some inclusions are known.
void check_loads(const std::vector<fem::Load>& loads,
                 const std::map<std::string, mesh::Motion>& motions);

}  // namespace anticrack::operators
