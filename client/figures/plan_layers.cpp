// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/plan_layers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

double mean_flux(const Triangle& t) { return (t[0].flux + t[1].flux + t[2].flux) / 3; }

double nearest(const Spot& spot, const std::vector<Spot>& others) {
  double least = HUGE_VAL;
  for (const Spot& other : others)
    least = std::min(least, std::hypot(other.x - spot.x, other.y - spot.y));
  return least;
}

void add_spots(const std::vector<Stretch>& stretches, std::vector<Spot>& to) {
  for (const Stretch& stretch : stretches) to.insert(to.end(), stretch.begin(), stretch.end());
}

/// The spot of a level with the most room around it, away from lines and farther from labels, where
/// its name covers no other one.
template <class Free>
std::pair<Spot, double> roomiest(const std::vector<Stretch>& stretches,
                                 const std::vector<Spot>& lines, const std::vector<Spot>& labels,
                                 const Free& is_free_at) {
  constexpr double width = 3;  // of a label, about, over its height
  constexpr std::size_t looked_at = 200;
  const std::size_t step = 1 + stretches.size() / looked_at;
  std::pair<Spot, double> best{{}, 0};
  for (std::size_t i = 0; i < stretches.size(); i += step) {
    const double room = std::min(nearest(stretches[i].front(), lines),
                                 nearest(stretches[i].front(), labels) / width);
    if (room > best.second && is_free_at(stretches[i].front())) best = {stretches[i].front(), room};
  }
  return best;
}

/// Every n-th, at most `most`.
std::vector<Spot> thinned(const std::vector<Spot>& all, std::size_t most) {
  std::vector<Spot> some;
  const std::size_t step = 1 + all.size() / most;
  for (std::size_t i = 0; i < all.size(); i += step) some.push_back(all[i]);
  return some;
}

/// Whether a case has the key, or a comment that looks like it.
bool gives_traction(std::string_view toml) {
  constexpr std::string_view key = "traction";
  for (std::size_t at = toml.find(key); at != std::string_view::npos; at = toml.find(key, at + 1)) {
    const std::size_t behind = toml.find_first_not_of(" \t\"'", at + key.size());
    if (behind != std::string_view::npos && toml[behind] == '=') return true;
  }
  return false;
}

}  // namespace

results::MeshPlan plan_of(const results::Result& result) {
  results::MeshPlan plan{result.title, result.units, result.mesh, {}, {}};
  plan.free = !result.case_text.empty() && !gives_traction(result.case_text);
  std::map<std::pair<double, double>, std::int32_t> nodes;
  for (const results::Interface& interface : result.interfaces)
    for (std::size_t i = 0; i < interface.node_count(); ++i)
      nodes[{interface.x[i], interface.y[i]}] = -1;
  for (std::size_t i = 0; i < result.mesh.node_count(); ++i)
    if (const auto found = nodes.find({result.mesh.xy[2 * i], result.mesh.xy[2 * i + 1]});
        found != nodes.end())
      found->second = static_cast<std::int32_t>(i);
  for (const results::Interface& interface : result.interfaces) {
    results::InterfaceLine line{interface.name, {}, interface.edges};
    for (std::size_t i = 0; i < interface.node_count(); ++i) {
      const std::int32_t node = nodes.at({interface.x[i], interface.y[i]});
      if (node >= 0) line.nodes.push_back(node);
    }
    // A file of another program may have rounded them.
    if (line.nodes.size() == interface.node_count()) plan.interfaces.push_back(std::move(line));
  }
  return plan;
}

Peaks flux_peaks(const Surface& surface) {
  constexpr double part = 0.98, room = 1.5;
  return peaks(surface.fluxes, part, room);
}

std::vector<std::vector<std::array<Spot, 3>>> flux_classes(const Surface& surface,
                                                           const Peaks& flux, std::size_t classes) {
  std::vector<std::vector<std::array<Spot, 3>>> sorted(classes);
  for (const Triangle& triangle : surface.triangles) {
    const double part = flux.shown > 0 ? mean_flux(triangle) / flux.shown : 0;
    if (!std::isfinite(part)) continue;
    const auto at = static_cast<std::size_t>(static_cast<double>(classes) * std::min(part, 1.0));
    sorted[std::min(at, classes - 1)].push_back({{{triangle[0].x, triangle[0].y},
                                                  {triangle[1].x, triangle[1].y},
                                                  {triangle[2].x, triangle[2].y}}});
  }
  return sorted;
}

std::vector<Stretch> contour(const Surface& surface, double level) {
  std::vector<Stretch> lines;
  for (const Triangle& triangle : surface.triangles) {
    Stretch line;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vertex &a = triangle[c], &b = triangle[(c + 1) % 3];
      // What is on the level counts as above it, so that a line has two ends.
      if ((a.u < level) == (b.u < level)) continue;
      const double along = (level - a.u) / (b.u - a.u);
      line.push_back({std::lerp(a.x, b.x, along), std::lerp(a.y, b.y, along)});
    }
    if (line.size() == 2) lines.push_back(std::move(line));
  }
  return lines;
}

MeshLayers plan_layers(const results::Result& result, const Surface& surface, const Peaks& flux,
                       std::size_t classes, int most) {
  const results::MeshPlan plan = plan_of(result);
  const Window window = whole(plan.mesh);
  const double size = std::max(window.width(), window.height());
  MeshLayers layers = figures::layers(plan, window, Named::inclusions);
  layers.triangles = flux_classes(surface, flux, classes);
  layers.triangle_count = surface.triangles.size();

  std::vector<Spot> taken;
  add_spots(layers.dirichlet, taken);
  add_spots(layers.neumann, taken);
  for (const auto& stretches : layers.interfaces) add_spots(stretches, taken);
  taken = thinned(taken, 1000);
  std::vector<Spot> labels;
  for (const Pointer& inclusion : layers.inclusions) labels.push_back(inclusion.to);
  const Range u{surface.lowest, surface.highest};
  if (!(u.size() > 0)) return layers;
  const double step = label_step(u, most);
  for (double index = std::ceil(u.low / step); index * step <= u.high; ++index) {
    const std::vector<Stretch> lines = contour(surface, index * step);
    const std::string name = readable(index * step, 3);
    const auto [spot, room] = roomiest(lines, taken, labels, [&](const Spot& at) {
      return is_free(name_box(name, at, window), layers.taken);
    });
    if (room > 0.045 * size) {
      layers.levels.emplace_back(spot, name);
      layers.taken.push_back(name_box(name, spot, window));
      labels.push_back(spot);
    }
    layers.contours.insert(layers.contours.end(), lines.begin(), lines.end());
  }
  return layers;
}

}  // namespace anticrack::figures
