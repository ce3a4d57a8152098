// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

namespace anticrack::figures {
namespace {

using results::Load;
using results::Mesh;
using results::Result;

/// Nodes of the same class may be merged: 0 interior, 1 boundary of the membrane, 2 interface, 3
/// both.
std::vector<std::size_t> classes(const Result& result) {
  const Mesh& mesh = result.mesh;
  std::vector<std::size_t> of(mesh.node_count(), 0);
  for (const std::int32_t node : mesh.boundary) of[static_cast<std::size_t>(node)] = 1;
  // The mesh does not say which nodes lie on an interface; those of two subdomains do.
  std::vector<std::int32_t> first(mesh.node_count(), -1);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto node = static_cast<std::size_t>(mesh.triangles[3 * t + c]);
      if (first[node] < 0) first[node] = mesh.subdomain[t];
      if (first[node] != mesh.subdomain[t]) of[node] = of[node] == 1 ? 3 : 2;
    }
  }
  return of;
}

/// For every node the node it is merged into: the first of its class in its cell of a grid.
std::vector<std::size_t> merged(const Mesh& mesh, const std::vector<std::size_t>& of,
                                const Surface& box, double cell) {
  std::map<std::tuple<std::size_t, std::int64_t, std::int64_t>, std::size_t> seen;
  std::vector<std::size_t> into(mesh.node_count());
  for (std::size_t i = 0; i < into.size(); ++i) {
    const auto column = static_cast<std::int64_t>(std::floor((mesh.xy[2 * i] - box.x_min) / cell));
    const auto row = static_cast<std::int64_t>(std::floor((mesh.xy[2 * i + 1] - box.y_min) / cell));
    into[i] = seen.try_emplace({of[i], column, row}, i).first->second;
  }
  return into;
}

using Corners = std::array<std::size_t, 3>;

struct Coarse {
  std::vector<Corners> triangles;
  std::vector<std::size_t> subdomain;
};

Coarse collapse(const Mesh& mesh, const std::vector<std::size_t>& into) {
  Coarse coarse;
  std::set<std::pair<Corners, std::size_t>> seen;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    Corners corners{};
    for (std::size_t c = 0; c < 3; ++c) {
      corners[c] = into[static_cast<std::size_t>(mesh.triangles[3 * t + c])];
    }
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    const auto subdomain = static_cast<std::size_t>(mesh.subdomain[t]);
    Corners key = corners;
    std::sort(key.begin(), key.end());
    if (!seen.insert({key, subdomain}).second) continue;
    coarse.triangles.push_back(corners);
    coarse.subdomain.push_back(subdomain);
  }
  return coarse;
}

Coarse coarsen(const Result& result, const Surface& box, std::size_t limit) {
  const Mesh& mesh = result.mesh;
  std::vector<std::size_t> into(mesh.node_count());
  std::iota(into.begin(), into.end(), std::size_t{0});
  Coarse coarse = collapse(mesh, into);
  if (coarse.triangles.size() <= limit) return coarse;

  const std::vector<std::size_t> of = classes(result);
  // Two triangles a cell to begin with; graded meshes need more than one step.
  double cell = box.width() * std::sqrt(2.0 / static_cast<double>(limit));
  while (coarse.triangles.size() > limit && cell < box.width()) {
    coarse = collapse(mesh, merged(mesh, of, box, cell));
    cell *= 1.2;
  }
  return coarse;
}

std::vector<std::vector<double>> values_by_node(const Result& result, const Load& load) {
  std::vector<std::vector<double>> u(
      load.fields.size(), std::vector<double>(result.mesh.node_count(), results::unknown));
  for (std::size_t d = 0; d < load.fields.size(); ++d) {
    const results::Field& field = load.fields[d];
    for (std::size_t i = 0; i < field.nodes.size(); ++i) {
      u[d][static_cast<std::size_t>(field.nodes[i])] = field.u[i];
    }
  }
  return u;
}

}  // namespace

double Surface::largest() const noexcept {
  return std::max(-lowest, highest);
}

double Surface::width() const noexcept {
  return std::max(x_max - x_min, y_max - y_min);
}

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

  const auto u = values_by_node(result, load);
  const Coarse coarse = coarsen(result, surface, limit);
  for (std::size_t t = 0; t < coarse.triangles.size(); ++t) {
    Triangle triangle;
    bool finite = true;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t node = coarse.triangles[t][c];
      triangle[c] = {mesh.xy[2 * node], mesh.xy[2 * node + 1], u[coarse.subdomain[t]][node]};
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

double amplification(const Surface& surface) {
  const double wanted = 0.38 * surface.width() / (surface.highest - surface.lowest);
  if (!std::isfinite(wanted) || wanted <= 0) return 1;
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  const double leading = wanted / power;
  double factor = 1;
  for (const double step : {1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0}) {
    if (step <= leading) factor = step;
  }
  return factor * power;
}

}  // namespace anticrack::figures
