// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/shapes.hpp"

#include "mesh/at.hpp"

namespace anticrack::estimate {

std::size_t Shapes::bytes() const noexcept {
  const auto of = [](const auto& list) { return list.capacity() * sizeof(list[0]); };
  return of(area) + of(tension) + of(edge) + of(weight) + of(around) + of(softness);
}

Shapes shapes(const Triangles& triangles, const Fans& fans) {
  const std::size_t count = triangles.copy.size() / 3;
  Shapes shapes;
  shapes.tension.resize(count);
  for (std::size_t s = 0; s < triangles.tension.size(); ++s)
    for (auto t = at(triangles.first_triangle[s]); t < at(triangles.first_triangle[s + 1]); ++t)
      shapes.tension[t] = triangles.tension[s];
  shapes.area.resize(count);
  shapes.weight.resize(count);
  shapes.edge.resize(3 * count);
  for (std::size_t t = 0; t < count; ++t) {
    Vector* edge = &shapes.edge[3 * t];
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector& from = triangles.at[at(triangles.copy[3 * t + (i + 1) % 3])];
      const Vector& to = triangles.at[at(triangles.copy[3 * t + (i + 2) % 3])];
      edge[i] = {to[0] - from[0], to[1] - from[1]};
    }
    shapes.area[t] = 0.5 * (edge[2][1] * edge[1][0] - edge[2][0] * edge[1][1]);
    for (std::size_t i = 0; i < 3; ++i)
      shapes.weight[t][i] =
          -shapes.tension[t] * dot(edge[(i + 1) % 3], edge[(i + 2) % 3]) / (2 * shapes.area[t]);
  }
  shapes.around.reserve(fans.corners.size());
  shapes.softness.reserve(fans.first_corner.size());
  for (std::size_t fan = 0; fan + 1 < fans.first_corner.size(); ++fan) {
    double stiffness = 0;
    for (auto n = at(fans.first_corner[fan]); n < at(fans.first_corner[fan + 1]); ++n) {
      const std::size_t corner = at(fans.corners[n]), t = corner / 3, i = corner % 3;
      const Vector* edge = &shapes.edge[3 * t];
      const Vector &own = edge[i], &j = edge[(i + 1) % 3], &k = edge[(i + 2) % 3];
      const double area = shapes.area[t], tension = shapes.tension[t], scale = area * tension;
      const auto first = static_cast<std::int32_t>(3 * t);
      shapes.around.push_back({fans.corners[n],
                               first + static_cast<std::int32_t>((i + 1) % 3),
                               first + static_cast<std::int32_t>((i + 2) % 3),
                               first / 3,
                               (dot(own, own) - dot(own, k)) / (12 * scale),
                               (dot(own, j) - dot(own, own)) / (12 * scale),
                               {own[0] / (2 * tension), own[1] / (2 * tension)},
                               tension / area});
      stiffness += dot(own, own) / (4 * scale);
    }
    shapes.softness.push_back(1 / stiffness);
  }
  return shapes;
}

}  // namespace anticrack::estimate
