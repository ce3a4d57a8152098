// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry_faces.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <unordered_map>
#include <utility>

#include "base/at.hpp"
#include "base/union_find.hpp"
#include "mesh/geometry_primitives.hpp"

namespace anticrack::mesh {
namespace {

using EdgeSpan = std::span<const std::array<int, 2>>;

/// Half-edge 2e runs along edge e, 2e + 1 against it.
class Walker {
 public:
  Walker(std::span<const Point> points, EdgeSpan edges, const std::vector<bool>& used)
      : _points(points), _edges(edges), _used(used), _next(2 * edges.size(), -1) {
    link();
  }

  int start(int half) const { return _edges[at(half / 2)][at(half % 2)]; }
  const Point& start_point(int half) const { return _points[at(start(half))]; }

  std::vector<std::vector<int>> loops() const {
    std::vector<std::vector<int>> all;
    std::vector<bool> walked(_next.size(), false);
    for (std::size_t first = 0; first < _next.size(); ++first) {
      if (walked[first] || !_used[first / 2]) continue;
      std::vector<int> loop;
      for (int half = static_cast<int>(first); !walked[at(half)]; half = _next[at(half)]) {
        walked[at(half)] = true;
        loop.push_back(half);
      }
      all.push_back(std::move(loop));
    }
    return all;
  }

  double area(const std::vector<int>& loop) const {
    const Point& o = start_point(loop.front());
    double twice = 0;
    for (const int half : loop) {
      const Point& a = start_point(half);
      const Point& b = start_point(half ^ 1);
      twice += (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
    }
    return twice / 2;
  }

  /// The bounding box of a loop, from the lowest to the highest coordinates.
  Segment box(const std::vector<int>& loop) const {
    Segment box{start_point(loop.front()), start_point(loop.front())};
    for (const int half : loop) {
      for (std::size_t k = 0; k < 2; ++k) {
        box.a[k] = std::min(box.a[k], start_point(half)[k]);
        box.b[k] = std::max(box.b[k], start_point(half)[k]);
      }
    }
    return box;
  }

  bool holds(const std::vector<int>& loop, const Point& p) const {
    bool odd = false;
    for (const int half : loop) {
      Point a = start_point(half);
      Point b = start_point(half ^ 1);
      if ((a[1] > p[1]) == (b[1] > p[1])) continue;
      if (a[1] > b[1]) std::swap(a, b);
      if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) odd = !odd;
    }
    return odd;
  }

  /// For each vertex the number of its connected part.
  std::vector<int> parts() const {
    base::UnionFind sets(_points.size());
    for (std::size_t e = 0; e < _edges.size(); ++e)
      if (_used[e]) sets.unite(_edges[e][0], _edges[e][1]);
    std::vector<int> part(_points.size());
    for (std::size_t v = 0; v < part.size(); ++v) part[v] = sets.find(static_cast<int>(v));
    return part;
  }

 private:
  void link() {
    struct Spoke {
      int vertex = 0;
      double angle = 0;
      int half = 0;
    };
    std::vector<Spoke> spokes;
    spokes.reserve(_next.size());
    for (std::size_t h = 0; h < _next.size(); ++h) {
      if (!_used[h / 2]) continue;
      const int half = static_cast<int>(h);
      const Point& a = start_point(half);
      const Point& b = start_point(half ^ 1);
      spokes.push_back({start(half), std::atan2(b[1] - a[1], b[0] - a[0]), half});
    }
    std::sort(spokes.begin(), spokes.end(), [](const Spoke& a, const Spoke& b) {
      if (a.vertex != b.vertex) return a.vertex < b.vertex;
      return a.angle != b.angle ? a.angle < b.angle : a.half < b.half;
    });
    for (std::size_t first = 0; first < spokes.size();) {
      std::size_t end = first;
      while (end < spokes.size() && spokes[end].vertex == spokes[first].vertex) ++end;
      // a walk that arrives along a spoke leaves along the next one clockwise
      for (std::size_t i = first; i < end; ++i) {
        const std::size_t clockwise = i == first ? end - 1 : i - 1;
        _next[at(spokes[i].half ^ 1)] = spokes[clockwise].half;
      }
      first = end;
    }
  }

  std::span<const Point> _points;
  EdgeSpan _edges;
  const std::vector<bool>& _used;
  std::vector<int> _next;
};

/// Splits `loop` into loops that pass no vertex twice and together walk its half-edges.
std::vector<std::vector<int>> simple_loops(const Walker& walker, const std::vector<int>& loop) {
  std::vector<std::vector<int>> all;
  std::vector<int> path;
  std::unordered_map<int, std::size_t> place;  // position on the path of each vertex that it passes
  for (const int half : loop) {
    const auto found = place.find(walker.start(half));
    if (found != place.end()) {
      const std::size_t from = found->second;
      all.emplace_back(path.begin() + static_cast<std::ptrdiff_t>(from), path.end());
      for (const int walked : all.back()) place.erase(walker.start(walked));
      path.resize(from);
    }
    place.emplace(walker.start(half), path.size());
    path.push_back(half);
  }
  all.push_back(std::move(path));
  return all;
}

Loop signed_edges(const std::vector<int>& halves) {
  Loop loop;
  loop.reserve(halves.size());
  for (const int half : halves) loop.push_back(half % 2 == 0 ? half / 2 + 1 : -(half / 2 + 1));
  return loop;
}

void add_loop(const Walker& walker, const std::vector<int>& halves, bool is_outer, Face& face) {
  std::vector<std::vector<int>> simple = simple_loops(walker, halves);
  std::size_t outer = simple.size();
  if (is_outer) {
    const auto less = [&](const auto& a, const auto& b) { return walker.area(a) < walker.area(b); };
    outer = at(std::max_element(simple.begin(), simple.end(), less) - simple.begin());
  }
  for (std::size_t i = 0; i < simple.size(); ++i)
    if (i == outer)
      face.outer = signed_edges(simple[i]);
    else
      face.holes.push_back(signed_edges(simple[i]));
}

}  // namespace

Arrangement arrange(std::span<const Point> points, EdgeSpan edges, const std::vector<bool>& used) {
  const Walker walker(points, edges, used);
  const std::vector<std::vector<int>> loops = walker.loops();
  const std::vector<int> part = walker.parts();
  const auto part_of = [&](std::size_t loop) {
    return part[at(walker.start(loops[loop].front()))];
  };
  std::vector<double> area(loops.size());
  // each connected part has one loop around it: the one with the least (signed) area
  std::vector<std::size_t> around(points.size(), loops.size());
  for (std::size_t i = 0; i < loops.size(); ++i) {
    area[i] = walker.area(loops[i]);
    std::size_t& best = around[at(part_of(i))];
    if (best == loops.size() || area[i] < area[best]) best = i;
  }
  std::vector<Segment> box;
  box.reserve(loops.size());
  for (const std::vector<int>& loop : loops) box.push_back(walker.box(loop));
  Arrangement result;
  std::vector<int> face_of(loops.size(), Arrangement::outside);
  std::vector<std::size_t> loop_of;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (around[at(part_of(i))] == i) continue;
    face_of[i] = static_cast<int>(result.faces.size());
    loop_of.push_back(i);
    result.faces.emplace_back();
    result.faces.back().area = area[i];
    result.faces.back().box = box[i];
    add_loop(walker, loops[i], true, result.faces.back());
  }
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (around[at(part_of(i))] != i) continue;
    // the face whose outer loop is the smallest of another part that holds this part
    int home = Arrangement::outside;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t f = 0; f < loop_of.size(); ++f) {
      const std::size_t j = loop_of[f];
      if (area[j] >= least || part_of(j) == part_of(i)) continue;
      const Point& p = walker.start_point(loops[i].front());
      if (!boxes_meet(box[j], {p, p}, 0) || !walker.holds(loops[j], p)) continue;
      home = static_cast<int>(f);
      least = area[j];
    }
    face_of[i] = home;
    if (home != Arrangement::outside) add_loop(walker, loops[i], false, result.faces[at(home)]);
  }
  result.left.assign(edges.size(), Arrangement::outside);
  result.right.assign(edges.size(), Arrangement::outside);
  for (std::size_t i = 0; i < loops.size(); ++i)
    for (const int half : loops[i])
      (half % 2 == 0 ? result.left : result.right)[at(half / 2)] = face_of[i];
  return result;
}

int face_at(const Arrangement& arrangement, std::span<const Point> points, EdgeSpan edges,
            const Point& p) {
  int best = Arrangement::outside;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t f = 0; f < arrangement.faces.size(); ++f) {
    const Face& face = arrangement.faces[f];
    if (face.area >= least || !boxes_meet(face.box, {p, p}, 0)) continue;
    std::vector<Point> polygon;
    polygon.reserve(face.outer.size());
    for (const int edge : face.outer) {
      const auto& ends = edges[at(std::abs(edge) - 1)];
      polygon.push_back(points[at(edge > 0 ? ends[0] : ends[1])]);
    }
    if (!inside(p, polygon)) continue;
    best = static_cast<int>(f);
    least = face.area;
  }
  return best;
}

}  // namespace anticrack::mesh
