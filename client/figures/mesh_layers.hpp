// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a picture of a mesh consists of, cut down to what can be seen of it. For the sources of this
// folder only.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "results/mesh_plan.hpp"

namespace anticrack::figures {

struct Spot {
  double x = 0;
  double y = 0;
};

/// The part of the plane that a panel shows.
struct Window {
  double x_min = 0, x_max = 0, y_min = 0, y_max = 0;

  /// In the unit of the geometry.
  double width() const noexcept { return x_max - x_min; }
  double height() const noexcept { return y_max - y_min; }
};

using Stretch = std::vector<Spot>;  ///< a polyline

struct Pointer {
  Spot from, to;  ///< an arrow off the interface
  std::string name;
};

struct MeshLayers {
  std::vector<std::vector<std::array<Spot, 3>>> triangles;  ///< by subdomain
  std::size_t triangle_count = 0;                           ///< of those
  std::array<std::vector<Stretch>, 5> interfaces;           ///< by results::Kind, 0 unused
  std::vector<Stretch> dirichlet, neumann;                  ///< edges of the boundary
  std::vector<results::Tip> tips;
  std::vector<Pointer> plus_sides;  ///< of interfaces
  std::vector<Pointer> inclusions;  ///< into the minus sides
  std::vector<std::pair<Spot, std::string>> subdomain_names;
};

/// The whole mesh with a margin.
Window whole(const results::Mesh& mesh);

/// The neighbourhood of the tip with the smallest edge, so large that its triangles are a few
/// pixels or else a fortieth of the mesh; false where no tip is finer than the mesh around it.
bool finest_tip(const results::MeshPlan& plan, Window& window, results::Tip& tip);

/// What is inside the window and larger than about a pixel of it. O(triangles log triangles).
MeshLayers layers(const results::MeshPlan& plan, const Window& window);

}  // namespace anticrack::figures
