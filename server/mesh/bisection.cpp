// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/bisection.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "base/at.hpp"
#include "errors/errors.hpp"
#include "mesh/geometry_primitives.hpp"
#include "mesh/quality.hpp"
#include "mesh/refine.hpp"
#include "stop/stop.hpp"

namespace anticrack::mesh {
namespace {

std::size_t side_of(const Mesh& mesh, const EdgeUse& use) noexcept {
  const auto t = 3 * at(use.triangle);
  if (mesh.triangles[t] == use.from) return 0;
  return mesh.triangles[t + 1] == use.from ? 1 : 2;
}

double squared_length(const Mesh& mesh, std::int32_t a, std::int32_t b) noexcept {
  const auto [dx, dy] = minus(position(mesh, b), position(mesh, a));
  return dx * dx + dy * dy;
}

void check_plane(std::span<const EdgeUse> uses) {
  if (uses.size() < 2 || (uses.size() == 2 && uses[0].from != uses[1].from)) return;
  throw errors::Error(errors::Reason::mesh_invalid,
                      "the edge between nodes {} and {} belongs to {} triangles; refinement takes "
                      "one on each side at most",
                      uses[0].low(), uses[0].high(), uses.size());
}

std::uint64_t edge_key(std::int32_t a, std::int32_t b) noexcept {
  const auto low = static_cast<std::uint64_t>(std::min(a, b));
  const auto high = static_cast<std::uint64_t>(std::max(a, b));
  return low << 32U | high;
}

/// The nodes that a refinement put on edges. Takes 16 bytes for each edge of a line that was cut.
class Midpoints {
 public:
  /// Node `first + i` is the midpoint of the edge between the two nodes parents[i]. Keeps only
  /// midpoints of edges between nodes `on_line`, and adds them to `on_line`: these include all that
  /// cut lines. O(k + c log c) for c of them.
  Midpoints(std::int32_t first, std::span<const std::array<std::int32_t, 2>> parents,
            std::vector<bool> on_line);

  /// The midpoint of the edge, in either direction; -1 if it was not cut. O(log k).
  std::int32_t find(std::int32_t a, std::int32_t b) const noexcept;

 private:
  std::vector<std::pair<std::uint64_t, std::int32_t>> _cuts;  ///< (edge, midpoint), ascending
};

Midpoints::Midpoints(std::int32_t first, std::span<const std::array<std::int32_t, 2>> parents,
                     std::vector<bool> on_line) {
  std::int32_t node = first;
  for (const auto& [a, b] : parents) {
    stop::look_at_turn<stop::quick>(at(node), bisecting);
    on_line.push_back(on_line[at(a)] && on_line[at(b)]);
    if (on_line.back()) _cuts.emplace_back(edge_key(a, b), node);
    ++node;
  }
  std::sort(_cuts.begin(), _cuts.end());
}

std::int32_t Midpoints::find(std::int32_t a, std::int32_t b) const noexcept {
  const std::uint64_t key = edge_key(a, b);
  const auto cut =
      std::lower_bound(_cuts.begin(), _cuts.end(), key,
                       [](const auto& one, auto wanted) { return one.first < wanted; });
  return cut != _cuts.end() && cut->first == key ? cut->second : -1;
}

std::vector<bool> nodes_of_lines(const Mesh& mesh) {
  std::vector<bool> found(mesh.node_count(), false);
  for (const Interface& line : mesh.interfaces)
    for (const std::int32_t node : line.nodes) found[at(node)] = true;
  for (const auto& edge : mesh.dirichlet)
    for (const std::int32_t node : edge) found[at(node)] = true;
  for (const ChordEdge& edge : mesh.chords) found[at(edge.a)] = found[at(edge.b)] = true;
  return found;
}

/// Calls `piece(from, to)` for the pieces of the edge a -> b, in order.
template <class Piece>
void each_piece(std::int32_t a, std::int32_t b, const Midpoints& midpoints,
                std::vector<std::int32_t>& targets, Piece&& piece) {
  targets.assign(1, b);
  std::int32_t from = a;
  while (!targets.empty()) {
    const std::int32_t to = targets.back();
    const std::int32_t middle = midpoints.find(from, to);
    if (middle >= 0) {
      targets.push_back(middle);
    } else {
      piece(from, to);
      from = to;
      targets.pop_back();
    }
  }
}

/// Replaces edges on chords by their pieces.
std::vector<ChordEdge> cut_chords(const std::vector<ChordEdge>& chords,
                                  const Midpoints& midpoints) {
  std::vector<ChordEdge> pieces, waiting;
  for (const ChordEdge& chord : chords) {
    waiting.assign(1, chord);
    while (!waiting.empty()) {
      const ChordEdge edge = waiting.back();
      waiting.pop_back();
      const std::int32_t middle = midpoints.find(edge.a, edge.b);
      if (middle < 0) {
        pieces.push_back(edge);
      } else {
        const auto [first, second] = edge.halved(middle);
        waiting.push_back(second);
        waiting.push_back(first);
      }
    }
  }
  return pieces;
}

/// Replaces the edges of all interfaces and of the Dirichlet boundary by their pieces, recursively.
/// Pieces take the place, direction, kind and inclusion of the edge.
void cut_lines(Mesh& mesh, const Midpoints& midpoints) {
  std::vector<std::int32_t> targets;
  for (Interface& line : mesh.interfaces) {
    Interface cut{line.name, {line.nodes.front()}, {}, {}};
    for (std::size_t i = 0; i + 1 < line.nodes.size(); ++i) {
      each_piece(line.nodes[i], line.nodes[i + 1], midpoints, targets,
                 [&](std::int32_t, std::int32_t to) {
                   cut.nodes.push_back(to);
                   cut.kind.push_back(line.kind[i]);
                   cut.inclusion.push_back(line.inclusion[i]);
                 });
    }
    line = std::move(cut);
  }
  std::vector<std::array<std::int32_t, 2>> dirichlet;
  for (const auto& [a, b] : mesh.dirichlet) {
    each_piece(a, b, midpoints, targets, [&](std::int32_t from, std::int32_t to) {
      dirichlet.push_back({from, to});
    });
  }
  mesh.dirichlet = std::move(dirichlet);
}

}  // namespace

std::vector<std::uint8_t> reference_sides(const Mesh& mesh, const EdgeTable& edges) {
  std::vector<std::uint8_t> sides(mesh.triangle_count(), 0);
  if (mesh.bisection_bound > 0) return sides;
  std::vector<double> longest(mesh.triangle_count(), -1.0);
  std::size_t turn = 0;
  edges.each([&](std::span<const EdgeUse> uses) {
    stop::look_at_turn<stop::quick>(turn++, bisecting);
    const double length = squared_length(mesh, uses[0].low(), uses[0].high());
    for (const EdgeUse& use : uses) {
      const auto t = at(use.triangle);
      if (length > longest[t]) {
        longest[t] = length;
        sides[t] = static_cast<std::uint8_t>(side_of(mesh, use));
      }
    }
  });
  return sides;
}

Bisection::Bisection(const Mesh& base, std::size_t max_triangles)
    : _base(base), _max_triangles(max_triangles), _xy(base.xy), _subdomain(base.subdomain) {
  const EdgeTable edges(base.triangles);
  const std::vector<std::uint8_t> reference = reference_sides(base, edges);
  _origin.resize(base.triangle_count());
  std::iota(_origin.begin(), _origin.end(), 0);
  _corners.resize(base.triangle_count());
  for (std::size_t t = 0; t < _corners.size(); ++t) {
    stop::look_at_turn<std::size_t{1} << 17>(t, bisecting);
    for (std::size_t i = 0; i < 3; ++i)
      _corners[t][i] = base.triangles[3 * t + (reference[t] + i) % 3];
  }
  _across.assign(base.triangle_count(), {-1, -1, -1});
  std::size_t turn = 0;
  edges.each([&](std::span<const EdgeUse> uses) {
    stop::look_at_turn<stop::quick>(turn++, bisecting);
    check_plane(uses);
    if (uses.size() < 2) return;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto t = at(uses[i].triangle);
      _across[t][(side_of(base, uses[i]) + 3 - reference[t]) % 3] = uses[1 - i].triangle;
    }
  });
}

std::array<Point, 3> Bisection::corners(std::size_t triangle) const noexcept {
  std::array<Point, 3> points;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto node = 2 * at(_corners[triangle][i]);
    points[i] = {_xy[node], _xy[node + 1]};
  }
  return points;
}

std::int32_t Bisection::midpoint(std::int32_t a, std::int32_t b) {
  const auto node = static_cast<std::int32_t>(_xy.size() / 2);
  const auto i = 2 * at(a);
  const auto j = 2 * at(b);
  _xy.push_back(0.5 * (_xy[i] + _xy[j]));
  _xy.push_back(0.5 * (_xy[i + 1] + _xy[j + 1]));
  _parents.push_back({a, b});
  return node;
}

std::int32_t Bisection::append_triangle(std::int32_t like) {
  const auto t = static_cast<std::int32_t>(triangle_count());
  _corners.emplace_back();
  _across.emplace_back();
  _subdomain.push_back(_subdomain[at(like)]);
  _origin.push_back(_origin[at(like)]);
  return t;
}

/// Precondition: the triangle across the reference edge, if any, has the same reference edge.
void Bisection::bisect_along_reference(std::int32_t t) {
  const std::int32_t n = _across[at(t)][0];
  const auto start = _corners[at(t)][0];
  const std::int32_t m = midpoint(start, _corners[at(t)][1]);
  const std::int32_t t_new = append_triangle(t);
  const std::int32_t n_new = n < 0 ? -1 : append_triangle(n);

  // (a, b, c) with reference edge ab becomes (c, a, m), in its place, and (b, c, m). For the
  // triangle across ab, a and b change roles, so the half at a borders the new triangle there.
  const auto split = [&](std::int32_t old, std::int32_t fresh, std::int32_t across_old,
                         std::int32_t across_fresh) {
    const auto i = at(old);
    const auto j = at(fresh);
    const auto [a, b, c] = _corners[i];
    const auto [ab, bc, ca] = _across[i];
    _corners[i] = {c, a, m};
    _across[i] = {ca, across_fresh, fresh};
    _corners[j] = {b, c, m};
    _across[j] = {bc, old, across_old};
    if (bc >= 0) std::ranges::replace(_across[at(bc)], old, fresh);
  };
  split(t, t_new, n, n_new);
  if (n >= 0) split(n, n_new, t, t_new);
}

// The walk across reference edges ends for this reason. A base triangle has generation 0, children
// one more than their parent. An edge of a triangle of generation g has level g if it is the
// reference edge, else g + 1. Within a base triangle both sides of an edge agree on its level; on
// an edge of the base, and its pieces, they differ by at most one, the lower level being on the
// side where it was the reference edge. So a step from T across its reference edge e to N, whose
// reference edge is another one, never raises the generation. It keeps the generation only if e is
// a piece of the reference edge of T's base ancestor but not of N's; N's ancestor then has an edge
// that is larger in the strict order than any of T's. So no triangle is met twice.
bool Bisection::bisect(std::size_t triangle) {
  _waiting.assign(1, static_cast<std::int32_t>(triangle));
  while (!_waiting.empty()) {
    const std::int32_t t = _waiting.back();
    const std::int32_t n = _across[at(t)][0];
    if (n >= 0 && _across[at(n)][0] != t) {
      _waiting.push_back(n);
      continue;
    }
    if (triangle_count() + (n < 0 ? 1 : 2) > _max_triangles) return false;
    bisect_along_reference(t);
    _waiting.pop_back();
  }
  return true;
}

Mesh Bisection::finish() && {
  Mesh mesh = without_triangles(_base);
  mesh.xy = std::move(_xy);
  mesh.triangles.reserve(3 * _corners.size());
  for (std::size_t t = 0; t < _corners.size(); ++t) {
    stop::look_at_turn<std::size_t{1} << 17>(t, bisecting);
    mesh.triangles.insert(mesh.triangles.end(), _corners[t].begin(), _corners[t].end());
  }
  mesh.subdomain = std::move(_subdomain);
  mesh.interfaces = _base.interfaces;
  mesh.dirichlet = _base.dirichlet;
  mesh.bisection_bound = bisection_bound(_base);
  stop::look(bisecting);
  const Midpoints midpoints(static_cast<std::int32_t>(_base.node_count()), _parents,
                            nodes_of_lines(_base));
  cut_lines(mesh, midpoints);
  mesh.chords = cut_chords(_base.chords, midpoints);
  return mesh;
}

double bisection_bound(const Mesh& base) {
  if (base.bisection_bound > 0) return base.bisection_bound;
  const std::vector<std::uint8_t> reference = reference_sides(base, EdgeTable(base.triangles));
  Angle smallest;
  for (std::size_t t = 0; t < base.triangle_count(); ++t) {
    stop::look_at_turn(t, bisecting);
    const Point a = corner(base, t, reference[t]);
    const Point b = corner(base, t, (reference[t] + 1U) % 3);
    const Point c = corner(base, t, (reference[t] + 2U) % 3);
    const Point m{0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])};
    // The triangle and its children suffice: two grandchildren are similar to it; the other two are
    // congruent, have children similar to the first ones, and none of the smallest angles.
    smallest =
        std::min({smallest, least_angle(a, b, c), least_angle(c, a, m), least_angle(b, c, m)});
  }
  return smallest.degrees();
}

}  // namespace anticrack::mesh
