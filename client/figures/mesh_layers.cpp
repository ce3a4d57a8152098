// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/mesh_layers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

using results::InterfaceLine;
using results::Mesh;
using results::MeshPlan;

constexpr double panel_pixels = 1500;  // of a panel, about

Spot spot_of(const Mesh& mesh, std::int32_t node) {
  const auto i = 2 * static_cast<std::size_t>(node);
  return {mesh.xy[i], mesh.xy[i + 1]};
}

double distance(const Spot& a, const Spot& b) { return std::hypot(b.x - a.x, b.y - a.y); }

template <class Spots>
Window box_of(const Spots& spots) {
  constexpr double far = std::numeric_limits<double>::infinity();
  Window box{far, -far, far, -far};
  for (const Spot& spot : spots) {
    box.x_min = std::min(box.x_min, spot.x);
    box.x_max = std::max(box.x_max, spot.x);
    box.y_min = std::min(box.y_min, spot.y);
    box.y_max = std::max(box.y_max, spot.y);
  }
  return box;
}

bool overlap(const Window& a, const Window& b) {
  return a.x_min <= b.x_max && b.x_min <= a.x_max && a.y_min <= b.y_max && b.y_min <= a.y_max;
}

bool inside(const Spot& spot, const Window& window) {
  return spot.x >= window.x_min && spot.x <= window.x_max && spot.y >= window.y_min &&
         spot.y <= window.y_max;
}

double triangle_area(const std::array<Spot, 3>& t) {
  return 0.5 * ((t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[2].x - t[0].x) * (t[1].y - t[0].y));
}

std::array<Spot, 3> triangle_of(const Mesh& mesh, std::size_t t) {
  return {spot_of(mesh, mesh.triangles[3 * t]), spot_of(mesh, mesh.triangles[3 * t + 1]),
          spot_of(mesh, mesh.triangles[3 * t + 2])};
}

void add_triangles(const Mesh& mesh, const Window& window, MeshLayers& to) {
  to.triangles.resize(mesh.subdomains.size());
  const double smallest = std::max(window.width(), window.height()) / (2 * panel_pixels);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const std::array<Spot, 3> triangle = triangle_of(mesh, t);
    const Window box = box_of(triangle);
    if (overlap(box, window) && std::max(box.width(), box.height()) > smallest) {
      to.triangles[static_cast<std::size_t>(mesh.subdomain[t])].push_back(triangle);
      ++to.triangle_count;
    }
  }
}

void add_boundary(const Mesh& mesh, MeshLayers& to) {
  std::vector<Edge> prescribed;
  prescribed.reserve(mesh.boundary.size() / 2);
  for (std::size_t b = 0; b + 1 < mesh.boundary.size(); b += 2)
    prescribed.push_back(std::minmax<std::int32_t>({mesh.boundary[b], mesh.boundary[b + 1]}));
  std::sort(prescribed.begin(), prescribed.end());
  for (const Edge& edge : outer_edges(mesh)) {
    const bool given = std::binary_search(prescribed.begin(), prescribed.end(), edge);
    (given ? to.dirichlet : to.neumann)
        .push_back({spot_of(mesh, edge.first), spot_of(mesh, edge.second)});
  }
}

/// Runs of edges of one kind, without nodes too near to be told apart.
void add_stretches(const MeshPlan& plan, const InterfaceLine& line, double smallest,
                   MeshLayers& to) {
  for (std::size_t first = 0; first < line.edges.kind.size();) {
    std::size_t end = first + 1;
    while (end < line.edges.kind.size() && line.edges.kind[end] == line.edges.kind[first]) ++end;
    Stretch stretch{spot_of(plan.mesh, line.nodes[first])};
    for (std::size_t i = first + 1; i <= end; ++i) {
      const Spot spot = spot_of(plan.mesh, line.nodes[i]);
      if (i == end || distance(stretch.back(), spot) > smallest) stretch.push_back(spot);
    }
    to.interfaces[static_cast<std::size_t>(line.edges.kind[first])].push_back(std::move(stretch));
    first = end;
  }
}

/// Of the name at the end of an arrow.
Window box_of(const Pointer& pointer, const Window& window) {
  const Window at_end = name_box(pointer.name, pointer.to, window);
  const double dx = pointer.to.x < pointer.from.x ? -0.5 : 0.5;
  const double dy = pointer.to.y < pointer.from.y ? -0.5 : 0.5;
  Spot middle = pointer.to;
  if (pointer.sideways())
    middle.x += dx * at_end.width();
  else
    middle.y += dy * at_end.height();
  return name_box(pointer.name, middle, window);
}

/// An arrow into the plus side, at the part `where` of the length of the edges for which `meant` is
/// true and which the window shows.
template <class Meant>
std::optional<Pointer> pointer(const MeshPlan& plan, const InterfaceLine& line,
                               const Window& window, double where, const Meant& meant) {
  double shown = 0;
  std::vector<double> lengths(line.edges.kind.size(), 0);
  for (std::size_t e = 0; e < line.edges.kind.size(); ++e) {
    const Spot a = spot_of(plan.mesh, line.nodes[e]);
    const Spot b = spot_of(plan.mesh, line.nodes[e + 1]);
    if (meant(e) && inside(a, window) && inside(b, window)) lengths[e] = distance(a, b);
    shown += lengths[e];
  }
  double walked = 0;
  for (std::size_t e = 0; e < lengths.size(); ++e) {
    if (lengths[e] == 0 || walked + lengths[e] < where * shown) {
      walked += lengths[e];
      continue;
    }
    const Spot a = spot_of(plan.mesh, line.nodes[e]);
    const Spot b = spot_of(plan.mesh, line.nodes[e + 1]);
    const double along = (where * shown - walked) / lengths[e];
    const Spot from{a.x + along * (b.x - a.x), a.y + along * (b.y - a.y)};
    const double reach = 0.05 * std::max(window.width(), window.height()) / lengths[e];
    return Pointer{from, {from.x - reach * (b.y - a.y), from.y + reach * (b.x - a.x)}, line.name};
  }
  return std::nullopt;
}

/// Names and arrows of more would cover the lines.
constexpr std::size_t most_pointers = 16;

/// A pointer and where else along its line it may stand.
using Choices = std::vector<Pointer>;

/// Of each the one whose name covers no other one, and the least of the interfaces; where every
/// name would cover one, none.
void place_names(const std::vector<Choices>& all, const Window& window, MeshLayers& to,
                 std::vector<Pointer>& placed) {
  if (all.size() > most_pointers) return;
  for (const Choices& choices : all) {
    const Pointer* best = nullptr;
    std::ptrdiff_t least = std::numeric_limits<std::ptrdiff_t>::max();
    for (const Pointer& pointer : choices) {
      const Window box = box_of(pointer, window);
      if (!is_free(box, to.taken)) continue;
      std::ptrdiff_t covered = 0;
      for (const auto& stretches : to.interfaces)
        for (const Stretch& stretch : stretches)
          covered +=
              std::ranges::count_if(stretch, [&](const Spot& spot) { return inside(spot, box); });
      if (covered < least) best = &pointer;
      least = std::min(least, covered);
    }
    if (best == nullptr) continue;
    to.taken.push_back(box_of(*best, window));
    to.taken.push_back(box_of(Stretch{best->from, best->to}));
    placed.push_back(*best);
  }
}

void add_plus_sides(const MeshPlan& plan, const Window& window, MeshLayers& to) {
  std::vector<Choices> all;
  for (const InterfaceLine& line : plan.interfaces) {
    Choices choices;
    // A little off the middle: there may be a tip, a cross point or another interface's arrow.
    for (const double where : {0.56, 0.3, 0.8, 0.42, 0.15, 0.9}) {
      auto found = pointer(plan, line, window, where, [](std::size_t) { return true; });
      if (!found) break;
      found->name += " +";
      choices.push_back(*found);
    }
    if (!choices.empty()) all.push_back(std::move(choices));
  }
  place_names(all, window, to, to.plus_sides);
}

void add_inclusions(const MeshPlan& plan, const Window& window, MeshLayers& to) {
  std::vector<Choices> all;
  for (const InterfaceLine& line : plan.interfaces) {
    std::set<std::int32_t> here(line.edges.inclusion.begin(), line.edges.inclusion.end());
    here.erase(-1);
    for (const std::int32_t inclusion : here) {
      const std::string& name = plan.mesh.inclusions[static_cast<std::size_t>(inclusion)];
      const auto is_it = [&](const Pointer& side) { return side.name == name + " +"; };
      if (std::ranges::any_of(to.plus_sides, is_it)) continue;
      Choices choices;
      for (const double where : {0.5, 0.25, 0.75, 0.1, 0.9}) {
        const auto found = pointer(plan, line, window, where, [&](std::size_t e) {
          return line.edges.inclusion[e] == inclusion;
        });
        if (!found) break;
        const Spot from = found->from;
        choices.push_back({from, {2 * from.x - found->to.x, 2 * from.y - found->to.y}, name});
      }
      if (!choices.empty()) all.push_back(std::move(choices));
    }
  }
  place_names(all, window, to, to.inclusions);
}

double squared(const Spot& a, const Spot& b) {
  return (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
}

/// At most `count` of them, evenly.
template <class T>
std::vector<T> thinned(const std::vector<T>& all, std::size_t count) {
  if (all.size() <= count) return all;
  std::vector<T> some;
  some.reserve(count);
  for (std::size_t i = 0; i < count; ++i) some.push_back(all[i * all.size() / count]);
  return some;
}

/// Where a subdomain has room for its name: far from all lines that are drawn.
void add_subdomain_names(const Mesh& mesh, const Window& window, MeshLayers& to) {
  std::vector<Spot> lines;
  const auto add = [&lines](const std::vector<Stretch>& stretches) {
    for (const Stretch& stretch : stretches)
      lines.insert(lines.end(), stretch.begin(), stretch.end());
  };
  add(to.dirichlet);
  add(to.neumann);
  std::ranges::for_each(to.interfaces, add);
  lines = thinned(lines, 1000);
  const double margin_x = 0.12 * window.width();
  const double margin_y = 0.08 * window.height();
  const Window room_for_names{window.x_min + margin_x, window.x_max - margin_x,
                              window.y_min + margin_y, window.y_max - margin_y};
  for (std::size_t d = 0; d < to.triangles.size(); ++d) {
    double best = 0;
    Spot place;
    for (const auto& triangle : thinned(to.triangles[d], 3000)) {
      const Spot centre{(triangle[0].x + triangle[1].x + triangle[2].x) / 3,
                        (triangle[0].y + triangle[1].y + triangle[2].y) / 3};
      if (!inside(centre, room_for_names) ||
          !is_free(name_box(mesh.subdomains[d], centre, window), to.taken))
        continue;
      double room = std::numeric_limits<double>::infinity();
      for (const Spot& spot : lines) room = std::min(room, squared(centre, spot));
      if (room > best) {
        best = room;
        place = centre;
      }
    }
    if (best == 0) continue;
    to.subdomain_names.emplace_back(place, mesh.subdomains[d]);
    to.taken.push_back(name_box(mesh.subdomains[d], place, window));
  }
}

}  // namespace

bool Pointer::sideways() const noexcept {
  return std::abs(to.x - from.x) > 0.5 * std::abs(to.y - from.y);
}

Window name_box(const std::string& name, const Spot& middle, const Window& window) {
  constexpr double character = 0.022, height = 0.055;  // of the longer side
  const double size = std::max(window.width(), window.height());
  const double half_x = 0.5 * size * character * static_cast<double>(length(name) + 1);
  const double half_y = 0.5 * size * height;
  return {middle.x - half_x, middle.x + half_x, middle.y - half_y, middle.y + half_y};
}

bool is_free(const Window& box, const std::vector<Window>& taken) {
  return std::ranges::none_of(taken, [&](const Window& other) { return overlap(box, other); });
}

Window whole(const Mesh& mesh) {
  std::vector<Spot> spots;
  spots.reserve(mesh.node_count());
  for (std::size_t i = 0; i < mesh.node_count(); ++i)
    spots.push_back({mesh.xy[2 * i], mesh.xy[2 * i + 1]});
  Window box = spots.empty() ? Window{0, 1, 0, 1} : box_of(spots);
  const double margin = 0.03 * std::max(box.width(), box.height());
  return {box.x_min - margin, box.x_max + margin, box.y_min - margin, box.y_max + margin};
}

bool finest_tip(const MeshPlan& plan, Window& window, results::Tip& tip) {
  if (plan.tips.empty() || plan.mesh.triangle_count() == 0) return false;
  tip = *std::min_element(plan.tips.begin(), plan.tips.end(), [](const auto& a, const auto& b) {
    return a.smallest_edge < b.smallest_edge;
  });
  double area = 0;
  for (std::size_t t = 0; t < plan.mesh.triangle_count(); ++t)
    area += triangle_area(triangle_of(plan.mesh, t));
  const double typical = std::sqrt(2 * area / static_cast<double>(plan.mesh.triangle_count()));
  if (tip.smallest_edge > typical / 4) return false;
  const Window all = whole(plan.mesh);
  const double half = std::max(all.width() / 40, 20 * tip.smallest_edge);
  window = {tip.x - half, tip.x + half, tip.y - half, tip.y + half};
  return true;
}

std::vector<Stretch> loose_sides(const std::vector<Stretch>& delaminated, double distance) {
  std::vector<Stretch> sides;
  for (const Stretch& stretch : delaminated) {
    Stretch side;
    for (std::size_t i = 0; i < stretch.size(); ++i) {
      const Spot& before = stretch[i == 0 ? 0 : i - 1];
      const Spot& after = stretch[std::min(i + 1, stretch.size() - 1)];
      const double dx = after.x - before.x, dy = after.y - before.y;
      const double length = std::hypot(dx, dy);
      if (length > 0)
        side.push_back(
            {stretch[i].x + distance * dy / length, stretch[i].y - distance * dx / length});
    }
    sides.push_back(std::move(side));
  }
  return sides;
}

MeshLayers layers(const MeshPlan& plan, const Window& window, Named names) {
  MeshLayers result;
  result.free = plan.free;
  add_triangles(plan.mesh, window, result);
  add_boundary(plan.mesh, result);
  const double smallest = std::max(window.width(), window.height()) / panel_pixels;
  for (const InterfaceLine& line : plan.interfaces) {
    add_stretches(plan, line, smallest, result);
    const Spot start = spot_of(plan.mesh, line.nodes.front());
    if (inside(start, window)) result.starts.push_back(start);
  }
  if (result.starts.size() > most_pointers) result.starts.clear();
  if (names == Named::all) add_plus_sides(plan, window, result);
  add_inclusions(plan, window, result);
  constexpr std::size_t delaminated = 4;  // index of the kind's stretches
  result.loose = loose_sides(result.interfaces[delaminated],
                             0.012 * std::max(window.width(), window.height()));
  for (const results::Tip& tip : plan.tips)
    if (inside({tip.x, tip.y}, window)) result.tips.push_back(tip);
  if (names == Named::all) add_subdomain_names(plan.mesh, window, result);
  return result;
}

std::vector<Edge> outer_edges(const results::Mesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      edges.push_back(std::minmax<std::int32_t>(
          {mesh.triangles[3 * t + c], mesh.triangles[3 * t + (c + 1) % 3]}));
    }
  }
  std::sort(edges.begin(), edges.end());
  std::vector<Edge> outer;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const bool shared =
        (i > 0 && edges[i - 1] == edges[i]) || (i + 1 < edges.size() && edges[i + 1] == edges[i]);
    if (!shared) outer.push_back(edges[i]);
  }
  return outer;
}

}  // namespace anticrack::figures
