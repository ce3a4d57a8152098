// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/mesh_figure.hpp"

#include <algorithm>
#include <utility>

#include "figures/axes.hpp"
#include "figures/drawing.hpp"
#include "figures/mesh_layers.hpp"
#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

/// Most triangles drawn: more are too small to see, and the SVG is too large for any program.
constexpr std::size_t drawn_triangles = 60000;

constexpr Canvas one_panel{85, 98};
constexpr Canvas two_panels{170, 91};

std::string counts(const results::Mesh& mesh) {
  return std::to_string(mesh.triangle_count()) + " triangles, " +
         std::to_string(mesh.node_count()) + " nodes";
}

std::string caption_of(const results::Tip& tip, const Window& window, const Window& whole,
                       const std::string& unit) {
  const double size = std::max(whole.width(), whole.height());
  return "at the tip " + point_text(tip.x, tip.y, size, 3) + ", \xC3\x97" +
         readable(whole.width() / window.width(), 2) + ", edges from " +
         readable(tip.smallest_edge, 2) + (unit.empty() ? "" : " " + unit);
}

bool few(const MeshLayers& layers, const std::string& where, std::vector<std::string>& notes) {
  if (layers.triangle_count <= drawn_triangles) return true;
  notes.push_back("no triangles drawn " + where + ": " + std::to_string(layers.triangle_count) +
                  " of them could not be told apart");
  return false;
}

}  // namespace

Picture mesh_picture(const results::MeshPlan& plan, std::vector<std::string>& notes) {
  const Window everything = whole(plan.mesh);
  const MeshLayers overview = layers(plan, everything);
  const MeshPanel first{"A", everything, counts(plan.mesh), few(overview, "in the whole", notes),
                        plan.units};
  const Title title{plan.title.empty() ? "mesh" : plan.title, ""};
  const std::string data = mesh_data(overview, first.tag);
  Window near;
  results::Tip tip;
  if (!finest_tip(plan, near, tip)) {
    return {data, title,
            [=](Format, const Place& area) {
              const int rows = legend_rows(overview, 2);
              const auto [panel, foot] = above_foot(area, one_panel, legend_height(rows));
              return mesh_panel(overview, first, panel, aspect(area, one_panel)) +
                     mesh_legend(overview, rows, foot);
            },
            one_panel};
  }
  const MeshLayers detail = layers(plan, near);
  const MeshPanel second{"B", near, caption_of(tip, near, everything, plan.units.label("L")),
                         few(detail, "around the tip", notes), plan.units};
  return {data + mesh_data(detail, second.tag), title,
          [=](Format, const Place& area) {
            const int rows = legend_rows(overview, 4);
            const auto [panels, foot] = above_foot(area, two_panels, legend_height(rows));
            const auto [left, right] = halves(panels);
            const double height = aspect(area, two_panels);
            return mesh_panel(overview, first, left, height) +
                   mesh_panel(detail, second, right, height) + mesh_legend(overview, rows, foot);
          },
          two_panels};
}

Drawn draw_mesh(const results::MeshPlan& plan, const std::string& name,
                const std::filesystem::path& folder, const Options& options) {
  const std::string fault = results::first_fault(plan);
  if (!fault.empty()) throw Error("the mesh is inconsistent: " + fault);
  Drawing drawing(folder, options);
  drawing.draw(file_stems({name}, {}).front(), mesh_picture(plan, drawing.drawn.notes));
  return std::move(drawing.drawn);
}

}  // namespace anticrack::figures
