// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/mesh_figure.hpp"

#include <utility>

#include "figures/drawing.hpp"
#include "figures/mesh_panel.hpp"
#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

/// More cannot be told apart, and make an SVG that no program shows.
constexpr std::size_t triangle_limit = 60000;

constexpr Place left{0, 0.09, 0.5, 0.85};
constexpr Place right{0.5, 0.09, 0.5, 0.85};
constexpr Place all{0, 0.09, 1, 0.85};
constexpr Place below{0, 0, 1, 0.09};

std::string counts(const results::Mesh& mesh) {
  return figures::quoted(std::to_string(mesh.triangle_count()) + " triangles, " +
                         std::to_string(mesh.node_count()) + " nodes");
}

std::string caption_of(const results::Tip& tip, const Window& window, const Window& whole) {
  return figures::quoted("around the tip (" + readable(tip.x, 6) + ", " + readable(tip.y, 6) +
                         "), \xC3\x97" + readable(whole.width() / window.width(), 3) +
                         ", smallest edge " + readable(tip.smallest_edge, 3));
}

bool few(const MeshLayers& layers, const std::string& where, std::vector<std::string>& notes) {
  if (layers.triangle_count <= triangle_limit) return true;
  notes.push_back("no triangles drawn " + where + ": " + std::to_string(layers.triangle_count) +
                  " of them could not be told apart");
  return false;
}

}  // namespace

std::string mesh_script(const results::MeshPlan& plan, const std::vector<Output>& outputs,
                        std::vector<std::string>& notes) {
  const Window everything = whole(plan.mesh);
  const MeshLayers overview = layers(plan, everything);
  const bool overview_triangles = few(overview, "in the whole", notes);
  const std::string title = figures::quoted(plan.title.empty() ? "mesh" : plan.title, 90);
  MeshPanel first{"A", everything, counts(plan.mesh), overview_triangles, all};
  Window near;
  results::Tip tip;
  if (!finest_tip(plan, near, tip)) {
    return script(
        mesh_data(overview, first.tag), title,
        [&](Format) { return mesh_panel(overview, first, single) + mesh_legend(overview, below); },
        single, outputs);
  }
  first.place = left;
  const MeshLayers detail = layers(plan, near);
  const bool detail_triangles = few(detail, "around the tip", notes);
  const MeshPanel second{"B", near, caption_of(tip, near, everything), detail_triangles, right};
  return script(
      mesh_data(overview, first.tag) + mesh_data(detail, second.tag), title,
      [&](Format) {
        return mesh_panel(overview, first, wide) + mesh_panel(detail, second, wide) +
               mesh_legend(overview, below);
      },
      wide, outputs);
}

Drawn draw_mesh(const results::MeshPlan& plan, const std::string& name,
                const std::filesystem::path& folder, const Options& options) {
  const std::string fault = results::first_fault(plan);
  if (!fault.empty()) throw Error("the mesh is inconsistent: " + fault);
  Drawing drawing(folder, options);
  drawing.draw(file_stems({name}, {}).front(), [&](const auto& outputs) {
    drawing.drawn.notes.clear();
    return mesh_script(plan, outputs, drawing.drawn.notes);
  });
  return std::move(drawing.drawn);
}

}  // namespace anticrack::figures
