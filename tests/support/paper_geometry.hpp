// SPDX-License-Identifier: GPL-3.0-or-later
//
// The membrane of section 8 of the paper: the square (-1,1) x (-1,1), the interface on y = 0, the
// inclusion on (-0.5,0.5), delaminated on its minus side from tip to tip.
#pragma once

#include "mesh/geometry.hpp"

namespace anticrack::testing {

inline mesh::Geometry paper_geometry() {
  mesh::Geometry geometry;
  geometry.boundary = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  geometry.interfaces = {{"interface", mesh::Shape::polyline, {{-1, 0}, {1, 0}}}};
  const mesh::Part part{{-0.5, 0}, {0.5, 0}};
  geometry.inclusions = {{"inclusion", part, {part}}};
  return geometry;
}

/// The preset the paper's meshes are made with.
inline mesh::MeshOptions paper_options() {
  mesh::MeshOptions options;
  options.preset = mesh::Preset::paper;
  return options;
}

}  // namespace anticrack::testing
