// SPDX-License-Identifier: GPL-3.0-or-later
//
// Random membranes: rectangles glued, cracked and stiffened along the lines of a grid, slits inside
// them, parts of the boundary free. Rich ones also have free cracks, inclusions that tilt, are
// fixed or share nodes, and all of these on the Dirichlet boundary.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "mesh/edges.hpp"
#include "support/grid_mesh.hpp"

namespace anticrack::reference {

/// Inclusions whose bodies tilt: all that share nodes do.
inline std::vector<char> tilting(const mesh::Mesh& mesh) {
  std::vector<char> tilts(mesh.inclusions.size(), 0);
  for (std::size_t j = 0; j < mesh.motions.size(); ++j) tilts[j] = mesh.motions[j].tilt ? 1 : 0;
  for (bool changed = true; changed;) {
    changed = false;
    std::map<std::int32_t, char> at_node;
    for (int round = 0; round < 2; ++round) {
      for (const mesh::Interface& interface : mesh.interfaces) {
        for (std::size_t e = 0; e < interface.kind.size(); ++e) {
          const std::int32_t j = interface.inclusion[e];
          for (const std::int32_t node : {interface.nodes[e], interface.nodes[e + 1]}) {
            if (j < 0) continue;
            char& all = at_node.try_emplace(node, 1).first->second;
            char& own = tilts[static_cast<std::size_t>(j)];
            changed = changed || all != own;
            all = own = static_cast<char>(all & own);
          }
        }
      }
      if (round == 0) changed = false;
    }
  }
  return tilts;
}

/// Whether a part of its boundary can carry a traction.
inline bool has_neumann(const mesh::Mesh& mesh) {
  std::size_t boundary = 0;
  mesh::EdgeTable(mesh.triangles).each([&](std::span<const mesh::EdgeUse> uses) {
    boundary += uses.size() == 1 ? 1 : 0;
  });
  return boundary > mesh.dirichlet.size();
}

class RandomMembrane {
 public:
  explicit RandomMembrane(unsigned seed, bool rich = false)
      : _random(seed),
        _rich(rich),
        _columns(pick(1, 3)),
        _rows(pick(1, 3)),
        _cells(pick(4, 6)),
        _grid(_columns * _cells, _rows * _cells, names(),
              [this](int i, int j) { return j / _cells * _columns + i / _cells; }) {
    _owner.assign(_grid.mesh.node_count(), -1);
    draw_lines();
    draw_slits();
    free_boundary();
    move_nodes();
    _grid.mesh.tension.reserve(_grid.mesh.subdomains.size());
    for (std::size_t s = 0; s < _grid.mesh.subdomains.size(); ++s) {
      _grid.mesh.tension.push_back(uniform(0.3, 3));
    }
  }

  const mesh::Mesh& mesh() const { return _grid.mesh; }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(_random);
  }

 private:
  using Point = testing::GridMesh::Point;
  using Kind = mesh::Kind;

  int pick(int low, int high) { return std::uniform_int_distribution<int>(low, high)(_random); }
  bool chance(double probability) { return uniform(0, 1) < probability; }

  std::vector<std::string> names() const {
    std::vector<std::string> result;
    result.reserve(static_cast<std::size_t>(_columns) * static_cast<std::size_t>(_rows));
    for (int s = 0; s < _columns * _rows; ++s) {
      result.push_back("part " + std::to_string(s));
    }
    return result;
  }

  /// One interface a side of a rectangle, either way round.
  void draw_lines() {
    for (int c = 1; c < _columns; ++c) {
      for (int r = 0; r < _rows; ++r) {
        draw({c * _cells, r * _cells}, {c * _cells, (r + 1) * _cells}, true);
      }
    }
    for (int r = 1; r < _rows; ++r) {
      for (int c = 0; c < _columns; ++c) {
        draw({c * _cells, r * _cells}, {(c + 1) * _cells, r * _cells}, true);
      }
    }
  }

  void draw_slits() {
    for (int c = 0; c < _columns; ++c) {
      for (int r = 0; r < _rows; ++r) {
        const int x = c * _cells, y = r * _cells + pick(1, _cells - 1);
        const int begin = pick(1, _cells - 2), end = pick(begin + 1, _cells - 1);
        if (chance(0.5)) {
          draw({x + begin, y}, {x + end, y}, false);
        }
      }
    }
  }

  bool on_boundary(Point p) const {
    return p[0] == 0 || p[1] == 0 || p[0] == _columns * _cells || p[1] == _rows * _cells;
  }

  /// Stretches of random kinds; glue at the boundary, and nowhere in a slit.
  void draw(Point from, Point to, bool glue) {
    if (chance(0.5)) {
      std::swap(from, to);
    }
    std::vector<Point> points = {from};
    while (points.back() != to) {
      Point next = points.back();
      for (std::size_t k = 0; k < 2; ++k) {
        next[k] += to[k] > next[k] ? 1 : to[k] < next[k] ? -1 : 0;
      }
      points.push_back(next);
    }
    const auto inclusion = static_cast<std::int32_t>(_grid.mesh.inclusions.size());
    std::vector<Kind> kinds;
    Kind kind = Kind::glue;
    bool held = false;
    for (std::size_t e = 0; e + 1 < points.size(); ++e) {
      if (e == 0 || chance(0.4)) {
        constexpr Kind all[] = {Kind::crack, Kind::delaminated, Kind::inclusion, Kind::glue};
        kind = all[pick(0, glue ? 3 : 2)];
        if (_rich && chance(0.25)) kind = Kind::free;
      }
      const bool ends = on_boundary(points[e]) || on_boundary(points[e + 1]);
      Kind here = ends && !_rich && glue ? Kind::glue : kind;
      if (here == Kind::inclusion || here == Kind::delaminated) {
        const bool taken =
            !_rich && (foreign(points[e], inclusion) || foreign(points[e + 1], inclusion));
        here = taken ? Kind::crack : here;
        held |= !taken;
        if (!taken) {
          own(points[e], inclusion);
          own(points[e + 1], inclusion);
        }
      }
      kinds.push_back(here);
    }
    if (held) {
      _grid.mesh.inclusions.push_back("inclusion " + std::to_string(inclusion));
      if (_rich) {
        const double which = uniform(0, 1);
        _grid.mesh.motions.push_back(
            {which<0.5, which> 0.9 ? std::optional<double>(0.3) : std::nullopt});
      }
    }
    _grid.add({from, to}, kinds, inclusion);
  }

  bool foreign(Point p, std::int32_t inclusion) const {
    const std::int32_t owner = _owner[static_cast<std::size_t>(_grid.node(p))];
    return owner >= 0 && owner != inclusion;
  }
  void own(Point p, std::int32_t inclusion) {
    _owner[static_cast<std::size_t>(_grid.node(p))] = inclusion;
  }

  void free_boundary() {
    const double right = _columns * _cells, top = _rows * _cells;
    const bool free_right = chance(0.4), free_top = chance(0.4);
    _grid.release(
        [&](double x, double y) { return (free_right && x == right) || (free_top && y == top); });
  }

  void move_nodes() {
    std::vector<double>& xy = _grid.mesh.xy;
    for (std::size_t i = 0; i < xy.size(); ++i) {
      xy[i] += uniform(-0.15, 0.15);
    }
  }

  std::mt19937 _random;
  bool _rich;
  int _columns, _rows, _cells;
  testing::GridMesh _grid;
  std::vector<std::int32_t> _owner;  // inclusion at each node
};

}  // namespace anticrack::reference
