// SPDX-License-Identifier: GPL-3.0-or-later
//
// A picture of a mesh: its layers, reduced to what can be seen, and its panels. For the sources of
// this folder only.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "figures/canvas.hpp"
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

  /// Whether the name stands beside the end of the arrow, and not above or below it.
  bool sideways() const noexcept;
};

/// About the part of the window that a name takes, with its middle at the spot.
Window name_box(const std::string& name, const Spot& middle, const Window& window);

/// Whether a part of the window is still free of names.
bool is_free(const Window& box, const std::vector<Window>& taken);

struct MeshLayers {
  std::vector<std::vector<std::array<Spot, 3>>> triangles;  ///< by subdomain
  std::size_t triangle_count = 0;                           ///< of those
  std::array<std::vector<Stretch>, 6> interfaces;           ///< by results::Kind, 0 unused
  std::vector<Stretch> dirichlet, neumann;                  ///< edges of the boundary
  std::vector<results::Tip> tips;
  std::vector<Spot> starts;         ///< of interfaces, where s = 0
  bool free = false;                ///< no traction acts on `neumann`
  std::vector<Pointer> plus_sides;  ///< of interfaces; where names would cover each other of some
  std::vector<Pointer> inclusions;  ///< into the minus sides; the same
  std::vector<std::pair<Spot, std::string>> subdomain_names;
  std::vector<Window> taken;                         ///< by names
  std::vector<Stretch> contours;                     ///< of u
  std::vector<std::pair<Spot, std::string>> levels;  ///< of contours
  std::vector<Stretch> loose;  ///< beside delaminated inclusions, on the side that came off
};

/// The whole mesh with a margin.
Window whole(const results::Mesh& mesh);

/// The neighbourhood of the tip with the smallest edge: a fortieth of the mesh, or more if its
/// triangles would be larger than a few pixels. False if no tip is finer than the mesh around it.
bool finest_tip(const results::MeshPlan& plan, Window& window, results::Tip& tip);

/// The delaminated stretches, `distance` away on their minus sides.
std::vector<Stretch> loose_sides(const std::vector<Stretch>& delaminated, double distance);

/// What has a name: an inclusion that has the name of its interface is not named twice.
enum class Named { inclusions, all };

/// All that is inside the window and larger than about a pixel. O(triangles log triangles).
MeshLayers layers(const results::MeshPlan& plan, const Window& window, Named names = Named::all);

/// Two nodes, the lower number first.
using Edge = std::pair<std::int32_t, std::int32_t>;

/// The boundary of the membrane: edges of only one triangle, sorted. O(m log m).
std::vector<Edge> outer_edges(const results::Mesh& mesh);

/// The data blocks of the layers; `tag` distinguishes panels.
std::string mesh_data(const MeshLayers& layers, const std::string& tag);

struct MeshPanel {
  std::string tag;  ///< of its data
  Window window;
  std::string caption;
  bool with_triangles = true;
  results::Units units{};
  std::vector<std::string> paints{};  ///< of the triangles, without their edges; none: pale ones
};

/// Draws the layers with equal scales in the middle of the place. `height`: of the picture, divided
/// by its width.
std::string mesh_panel(const MeshLayers& layers, const MeshPanel& panel, const Place& place,
                       double height);

/// Rows of the legend of all panels in that many columns, and their height, mm.
int legend_rows(const MeshLayers& layers, int columns);
inline double legend_height(int rows) { return 1.5 + 3.2 * rows; }

/// The legend, in columns of `rows` entries.
std::string mesh_legend(const MeshLayers& layers, int rows, const Place& place);

}  // namespace anticrack::figures
