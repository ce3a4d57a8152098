// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <set>
#include <utility>

#include "figures/mesh_layers.hpp"

namespace anticrack::figures {
namespace {

using results::Load;
using results::Mesh;
using results::Result;

using Corners = std::array<std::size_t, 3>;

/// The membrane cut open: a vertex for every face of a node.
struct Cut {
  std::vector<std::size_t> node;  // of the mesh, by vertex
  std::vector<double> u;
  std::vector<Corners> triangles;
  std::vector<double> tension;  // of each triangle
};

Cut cut_open(const Mesh& mesh, const Load& load) {
  Cut cut;
  for (std::size_t d = 0; d < load.fields.size(); ++d) {
    const results::Field& field = load.fields[d];
    const std::size_t first = cut.node.size();
    cut.node.insert(cut.node.end(), field.nodes.begin(), field.nodes.end());
    cut.u.insert(cut.u.end(), field.u.begin(), field.u.end());
    for (std::size_t t = 0; t + 2 < field.triangles.size(); t += 3) {
      Corners corners{};
      for (std::size_t c = 0; c < 3; ++c)
        corners[c] = first + static_cast<std::size_t>(field.triangles[t + c]);
      cut.triangles.push_back(corners);
    }
    cut.tension.resize(cut.triangles.size(), mesh.tension_law.empty() ? mesh.tension[d] : 1);
  }
  return cut;
}

/// All vertices, with the means over their triangles, whose own fluxes go to `fluxes`.
std::vector<Vertex> vertices(const Mesh& mesh, const Cut& cut,
                             std::vector<std::pair<double, double>>& fluxes) {
  std::vector<Vertex> all(cut.node.size());
  std::vector<double> area(cut.node.size(), 0);
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = {mesh.xy[2 * cut.node[i]], mesh.xy[2 * cut.node[i] + 1], cut.u[i]};
  for (std::size_t t = 0; t < cut.triangles.size(); ++t) {
    const Corners& corners = cut.triangles[t];
    const Vertex &a = all[corners[0]], &b = all[corners[1]], &c = all[corners[2]];
    const double twice = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    if (!(twice > 0)) continue;
    // Times twice the area.
    const double x = (b.u - a.u) * (c.y - a.y) - (c.u - a.u) * (b.y - a.y);
    const double y = (c.u - a.u) * (b.x - a.x) - (b.u - a.u) * (c.x - a.x);
    const double flux = cut.tension[t] * std::hypot(x, y);
    if (std::isfinite(flux)) fluxes.emplace_back(flux / twice, twice);
    for (const std::size_t corner : corners) {
      all[corner].slope_x += x;
      all[corner].slope_y += y;
      all[corner].flux += flux;
      area[corner] += twice;
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i)
    for (double Vertex::*mean : {&Vertex::slope_x, &Vertex::slope_y, &Vertex::flux})
      if (area[i] > 0) all[i].*mean /= area[i];
  return all;
}

/// Nodes on the boundary of the membrane, whatever holds there.
std::vector<bool> outer_nodes(const Mesh& mesh) {
  std::vector<bool> outer(mesh.node_count(), false);
  for (const Edge& edge : outer_edges(mesh)) {
    outer[static_cast<std::size_t>(edge.first)] = true;
    outer[static_cast<std::size_t>(edge.second)] = true;
  }
  return outer;
}

/// Only vertices of a class are merged: 0 interior, 1 boundary of the membrane, 2 interface, 3
/// both.
std::vector<int> classes(const Mesh& mesh, const Cut& cut) {
  std::vector<int> faces(mesh.node_count(), 0);
  for (const std::size_t node : cut.node) ++faces[node];
  const std::vector<bool> outer = outer_nodes(mesh);
  std::vector<int> of;
  of.reserve(cut.node.size());
  for (const std::size_t node : cut.node)
    of.push_back((outer[node] ? 1 : 0) + (faces[node] > 1 ? 2 : 0));
  return of;
}

/// Disjoint sets of vertices.
class Merger {
 public:
  explicit Merger(std::size_t count) : _parent(count) {
    std::iota(_parent.begin(), _parent.end(), std::size_t{0});
  }
  std::size_t find(std::size_t vertex) {
    while (_parent[vertex] != vertex) {
      _parent[vertex] = _parent[_parent[vertex]];
      vertex = _parent[vertex];
    }
    return vertex;
  }
  /// The first vertex represents the set.
  void merge(std::size_t a, std::size_t b) {
    a = find(a);
    b = find(b);
    _parent[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> _parent;
};

/// Merges neighbours of one class in one cell of a grid. Only neighbours: a cell may hold both
/// faces of a slit.
std::vector<std::size_t> merged(const Mesh& mesh, const Cut& cut, const std::vector<int>& of,
                                const Surface& box, double cell) {
  const auto cell_of = [&](std::size_t vertex, std::size_t axis) {
    const double origin = axis == 0 ? box.x_min : box.y_min;
    return std::floor((mesh.xy[2 * cut.node[vertex] + axis] - origin) / cell);
  };
  Merger merger(cut.node.size());
  for (const Corners& corners : cut.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t a = corners[c];
      const std::size_t b = corners[(c + 1) % 3];
      if (of[a] == of[b] && cell_of(a, 0) == cell_of(b, 0) && cell_of(a, 1) == cell_of(b, 1))
        merger.merge(a, b);
    }
  }
  std::vector<std::size_t> into(cut.node.size());
  for (std::size_t i = 0; i < into.size(); ++i) into[i] = merger.find(i);
  return into;
}

/// The triangles that are left, each once.
std::vector<Corners> collapse(const std::vector<Corners>& triangles,
                              const std::vector<std::size_t>& into) {
  std::vector<Corners> left;
  std::set<Corners> seen;
  for (const Corners& triangle : triangles) {
    const Corners corners{into[triangle[0]], into[triangle[1]], into[triangle[2]]};
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    Corners key = corners;
    std::sort(key.begin(), key.end());
    if (seen.insert(key).second) left.push_back(corners);
  }
  return left;
}

std::vector<Corners> coarsen(const Mesh& mesh, const Cut& cut, const Surface& box,
                             std::size_t limit) {
  std::vector<Corners> left = cut.triangles;
  if (left.size() <= limit) return left;
  const std::vector<int> of = classes(mesh, cut);
  // Two triangles a cell to begin with; graded meshes need more than one step.
  double cell = box.width() * std::sqrt(2.0 / static_cast<double>(limit));
  while (left.size() > limit && cell < box.width()) {
    left = collapse(cut.triangles, merged(mesh, cut, of, box, cell));
    cell *= 1.2;
  }
  return left;
}

}  // namespace

double Surface::largest() const noexcept { return std::max(-lowest, highest); }

double Surface::width() const noexcept { return std::max(x_max - x_min, y_max - y_min); }

Surface surface(const Result& result, const Load& load, std::size_t limit) {
  const Mesh& mesh = result.mesh;
  Surface surface;
  if (mesh.node_count() == 0) return surface;
  surface.x_min = surface.x_max = mesh.xy[0];
  surface.y_min = surface.y_max = mesh.xy[1];
  for (std::size_t i = 0; i < mesh.node_count(); ++i) {
    surface.x_min = std::min(surface.x_min, mesh.xy[2 * i]);
    surface.x_max = std::max(surface.x_max, mesh.xy[2 * i]);
    surface.y_min = std::min(surface.y_min, mesh.xy[2 * i + 1]);
    surface.y_max = std::max(surface.y_max, mesh.xy[2 * i + 1]);
  }

  const Cut cut = cut_open(mesh, load);
  const std::vector<Vertex> all = vertices(mesh, cut, surface.fluxes);
  for (const Corners& corners : coarsen(mesh, cut, surface, limit)) {
    Triangle triangle;
    bool finite = true;
    for (std::size_t c = 0; c < 3; ++c) {
      triangle[c] = all[corners[c]];
      finite = finite && std::isfinite(triangle[c].u);
    }
    if (!finite) continue;
    for (const Vertex& vertex : triangle) {
      surface.lowest = std::min(surface.lowest, vertex.u);
      surface.highest = std::max(surface.highest, vertex.u);
    }
    surface.triangles.push_back(triangle);
  }
  return surface;
}

std::vector<Triangle> refined(std::vector<Triangle> triangles, double longest, std::size_t limit) {
  const auto is_long = [&](const Triangle& t) {
    return std::max({std::hypot(t[1].x - t[0].x, t[1].y - t[0].y),
                     std::hypot(t[2].x - t[1].x, t[2].y - t[1].y),
                     std::hypot(t[0].x - t[2].x, t[0].y - t[2].y)}) > longest;
  };
  const auto middle = [](const Vertex& a, const Vertex& b) {
    return Vertex{(a.x + b.x) / 2,
                  (a.y + b.y) / 2,
                  (a.u + b.u) / 2,
                  (a.slope_x + b.slope_x) / 2,
                  (a.slope_y + b.slope_y) / 2,
                  (a.flux + b.flux) / 2};
  };
  for (;;) {
    const auto first = std::ranges::partition(triangles, std::not_fn(is_long)).begin();
    const std::vector<Triangle> coarse(first, triangles.end());
    if (coarse.empty() || triangles.size() + 3 * coarse.size() > limit) return triangles;
    triangles.erase(first, triangles.end());
    for (const auto& [a, b, c] : coarse) {
      const Vertex ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const Triangle& part : {Triangle{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
        triangles.push_back(part);
    }
  }
}

double amplification(const Surface& surface) {
  // Of a long sheet neither its length, or it would stand like a curtain, nor its width.
  const double size = std::sqrt((surface.x_max - surface.x_min) * (surface.y_max - surface.y_min));
  const double wanted = 0.3 * size / (surface.highest - surface.lowest);
  if (!std::isfinite(wanted) || wanted <= 0) return 1;
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  const double leading = wanted / power;
  double factor = 1;
  for (const double step : {1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (step <= leading) factor = step;
  return factor * power;
}

}  // namespace anticrack::figures
