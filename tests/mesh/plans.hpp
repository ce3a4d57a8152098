// SPDX-License-Identifier: GPL-3.0-or-later
//
// Geometries to plan, and what is asked of a plan.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "mesh/geometry.hpp"
#include "mesh/plan_checks.hpp"
#include "support/paper_geometry.hpp"

namespace anticrack::testing {

inline constexpr std::size_t enough = 4'000'000;  ///< triangles

inline mesh::Geometry square() {
  mesh::Geometry geometry = paper_geometry();
  geometry.interfaces.clear();
  geometry.inclusions.clear();
  return geometry;
}

inline mesh::InterfaceSpec polyline(const char* name, std::vector<mesh::Point> points,
                                    bool closed = false) {
  return {name, mesh::Shape::polyline, std::move(points), closed};
}

inline mesh::MeshOptions uniform(double size) {
  mesh::MeshOptions options;
  options.preset = mesh::Preset::uniform;
  options.size = size;
  return options;
}

inline mesh::Plan plan_of(const mesh::Geometry& geometry, double size = 0.25) {
  return mesh::plan(geometry, uniform(size), enough);
}

inline std::vector<std::string> chain_names(const mesh::Plan& plan) {
  std::vector<std::string> names;
  for (const auto& chain : plan.interfaces) names.push_back(chain.name);
  return names;
}

inline double length_of(const mesh::Plan& plan, mesh::Role role) {
  double sum = 0;
  for (const auto& c : plan.curves) sum += c.role == role ? length(plan, c) : 0;
  return sum;
}

}  // namespace anticrack::testing
