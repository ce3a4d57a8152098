// SPDX-License-Identifier: GPL-3.0-or-later
//
// Random membranes with many short inclusions and cracks.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "support/grid_mesh.hpp"

namespace anticrack::reference {

/// A square of 32 with ten to fifty of them along grid lines: bonded, delaminated, both, cracks
/// with and without contact, straight or with a corner. They cross, share nodes and end on the
/// boundary as it happens. Inclusions keep their direction, tilt or are fixed.
class RandomFibres {
 public:
  explicit RandomFibres(unsigned seed)
      : _random(seed), _grid(size, size, {"all"}, [](int, int) { return 0; }) {
    const int wanted = pick(10, 50);
    for (int tries = 0; count() < wanted && tries < 1000; ++tries) draw();
    const bool free_right = pick(0, 1) == 1;
    _grid.release([&](double x, double) { return free_right && x == size; });
    move_nodes();
    _grid.mesh.tension = {uniform(0.3, 3)};
  }

  const mesh::Mesh& mesh() const { return _grid.mesh; }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(_random);
  }

 private:
  using Point = testing::GridMesh::Point;
  using Kind = mesh::Kind;
  static constexpr int size = 32;

  int pick(int low, int high) { return std::uniform_int_distribution<int>(low, high)(_random); }
  int count() const { return static_cast<int>(_grid.mesh.interfaces.size()); }

  /// Along its first direction and, one in four, round a corner.
  std::vector<Point> corners() {
    std::vector<Point> points = {{pick(1, size - 1), pick(1, size - 1)}};
    std::size_t axis = static_cast<std::size_t>(pick(0, 1));
    for (int part = pick(0, 3) == 0 ? 0 : 1; part < 2; ++part, axis = 1 - axis) {
      Point next = points.back();
      next[axis] = std::clamp(next[axis] + (pick(0, 1) == 1 ? 1 : -1) * pick(2, 5), 0, size);
      points.push_back(next);
    }
    return points;
  }

  /// Node numbers of its edges, the smaller first; none where one is taken.
  std::vector<std::pair<std::int32_t, std::int32_t>> edges_of(const std::vector<Point>& points) {
    std::vector<std::pair<std::int32_t, std::int32_t>> edges;
    Point here = points.front();
    for (const Point& corner : points) {
      while (here != corner) {
        const std::int32_t before = _grid.node(here);
        for (std::size_t k = 0; k < 2; ++k)
          here[k] += corner[k] > here[k] ? 1 : corner[k] < here[k] ? -1 : 0;
        edges.push_back(std::minmax({before, _grid.node(here)}));
        if (_taken.contains(edges.back())) return {};
      }
    }
    return edges;
  }

  void draw() {
    const std::vector<Point> points = corners();
    const auto edges = edges_of(points);
    if (edges.size() < 2) return;
    // One that turns on the boundary would lie on it.
    if (points.size() > 2 && std::ranges::any_of(points[1], [](int x) { return x % size == 0; }))
      return;
    _taken.insert(edges.begin(), edges.end());
    constexpr Kind all[] = {Kind::crack, Kind::free, Kind::inclusion, Kind::delaminated,
                            Kind::delaminated};
    std::vector<Kind> kinds(edges.size(), all[pick(0, 4)]);
    const auto inclusion = static_cast<std::int32_t>(_grid.mesh.inclusions.size());
    if (kinds[0] == Kind::inclusion || kinds[0] == Kind::delaminated) {
      if (pick(0, 3) == 0) kinds[0] = Kind::inclusion;
      _grid.mesh.inclusions.push_back("fibre " + std::to_string(inclusion));
      const int which = pick(0, 9);
      _grid.mesh.motions.push_back({which < 5, which == 9 ? std::optional(0.3) : std::nullopt});
    }
    _grid.add(points, kinds, inclusion);
  }

  /// Inclusions stay as they are: one with a slight kink has next to nothing against tilting about
  /// its line, and its numbers no digits.
  void move_nodes() {
    std::vector<char> stays(_grid.mesh.node_count(), 0);
    for (const mesh::Interface& interface : _grid.mesh.interfaces)
      for (const std::int32_t node : interface.nodes)
        stays[static_cast<std::size_t>(node)] |= interface.inclusion[0] >= 0 ? 1 : 0;
    for (std::size_t i = 0; i < _grid.mesh.xy.size(); ++i)
      if (stays[i / 2] == 0) _grid.mesh.xy[i] += uniform(-0.15, 0.15);
  }

  std::mt19937 _random;
  testing::GridMesh _grid;
  std::set<std::pair<std::int32_t, std::int32_t>> _taken;
};

}  // namespace anticrack::reference
