// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/shapes.hpp"

#include <algorithm>

#include "base/at.hpp"
#include "stop/stop.hpp"

namespace anticrack::estimate {
namespace {

constexpr const char* measuring = "measuring triangles for bounds";

}  // namespace

std::size_t Shapes::bytes() const noexcept {
  const auto of = [](const auto& list) { return list.capacity() * sizeof(list[0]); };
  return of(area) + of(tension) + of(edge) + of(around) + of(softness) + of(variation);
}

Shapes shapes(const Triangles& triangles, const Fans& fans) {
  const std::size_t count = triangles.copy.size() / 3;
  Shapes shapes;
  shapes.tension.reserve(count);
  std::vector<fem::Isotropic> maps;
  maps.reserve(count);
  for (std::size_t s = 0; s < triangles.tension.size(); ++s) {
    const fem::Tension& tension = *triangles.tension[s];
    const auto first = at(triangles.first_triangle[s]);
    for (auto t = first; t < at(triangles.first_triangle[s + 1]); ++t) {
      stop::look_at_turn<stop::quick>(t, measuring);
      maps.push_back(tension.isotropic(t - first));
      shapes.tension.push_back(maps.back().tension);
      shapes.largest_tension = std::max(shapes.largest_tension, maps.back().tension);
    }
    if (tension.variation.empty()) continue;
    shapes.variation.resize(count);
    std::ranges::copy(tension.variation, &shapes.variation[first]);
  }
  shapes.area.resize(count);
  shapes.edge.resize(3 * count);
  for (std::size_t t = 0; t < count; ++t) {
    stop::look_at_turn<stop::quick>(t, measuring);
    Vector* edge = &shapes.edge[3 * t];
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector& from = triangles.at[at(triangles.copy[3 * t + (i + 1) % 3])];
      const Vector& to = triangles.at[at(triangles.copy[3 * t + (i + 2) % 3])];
      edge[i] = maps[t](to[0] - from[0], to[1] - from[1]);
    }
    shapes.area[t] = 0.5 * (edge[2][1] * edge[1][0] - edge[2][0] * edge[1][1]);
    const double length = shapes.length(t);
    for (std::size_t i = 0; i < 3; ++i) edge[i] = {edge[i][0] / length, edge[i][1] / length};
  }
  shapes.around.reserve(fans.corners.size());
  shapes.softness.reserve(fans.first_corner.size());
  for (std::size_t fan = 0; fan + 1 < fans.first_corner.size(); ++fan) {
    stop::look_at_turn<stop::quick>(fan, measuring);
    double stiffness = 0;
    for (auto n = at(fans.first_corner[fan]); n < at(fans.first_corner[fan + 1]); ++n) {
      const std::int32_t corner = fans.corners[n], t = corner / 3, i = corner % 3;
      const Vector& edge = shapes.edge[at(corner)];
      shapes.around.push_back({t, i, {edge[0], edge[1]}});
      stiffness += dot(edge, edge);
    }
    shapes.softness.push_back(1 / stiffness);
  }
  return shapes;
}

}  // namespace anticrack::estimate
