// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/cut_mesh.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <span>
#include <utility>

#include "base/at.hpp"
#include "errors/errors.hpp"
#include "mesh/edges.hpp"
#include "stop/stop.hpp"

namespace anticrack::estimate {
namespace {

constexpr const char* cutting = "preparing a mesh for bounds";

constexpr std::int32_t next(std::int32_t corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}
constexpr std::int32_t previous(std::int32_t corner) {
  return corner % 3 == 0 ? corner + 2 : corner - 1;
}

/// A multiple of four, so that threads have equal numbers of blocks, where blocks are large enough
/// to be worth it.
constexpr std::size_t block_count(std::size_t triangles, std::size_t block) {
  constexpr std::size_t equal = 4, worth = 16;
  const std::size_t least = triangles / block + 1;
  return triangles < equal * block / worth ? least : (least + equal - 1) / equal * equal;
}

class Cutting {
 public:
  Cutting(const mesh::Mesh& mesh, const ddm::Decomposition& decomposition)
      : _mesh(mesh), _decomposition(decomposition), _edges(mesh.triangles) {}

  CutMesh operator()(std::size_t block) {
    number();
    for (const ddm::RigidMotion& motion : _decomposition.skeleton.motions) {
      _cut.tilts.push_back(motion.slope_x.empty() && motion.slope_y.empty() ? 0 : 1);
      _cut.centre.push_back(motion.centre);
    }
    find_faces();
    find_chords();
    find_ways_out();
    find_fans();
    sort_fans(block);
    meet_triangles();
    find_obstacle();
    return std::move(_cut);
  }

  /// Per side: the side of the neighbour, negative if there is none.
  const std::vector<std::int32_t>& across() const { return _across; }

 private:
  void number() {
    _place.resize(_mesh.triangle_count());
    _cut.triangle.reserve(_mesh.triangle_count());
    _cut.copy.reserve(_mesh.triangles.size());
    _cut.first_triangle.push_back(0);
    _cut.first_copy.push_back(0);
    for (const ddm::Subdomain& subdomain : _decomposition.subdomains) {
      stop::look(cutting);
      const std::int32_t copies = _cut.first_copy.back();
      for (const std::int32_t triangle : subdomain.triangle) {
        stop::look_at_turn<stop::quick>(_cut.triangle.size(), cutting);
        _place[at(triangle)] = static_cast<std::int32_t>(_cut.triangle.size());
        _cut.triangle.push_back(triangle);
      }
      for (const std::int32_t node : subdomain.part.triangles) {
        stop::look_at_turn<stop::quick>(_cut.copy.size(), cutting);
        _cut.copy.push_back(copies + node);
      }
      stop::look(cutting);
      for (std::size_t i = 0; i < subdomain.part.node_count(); ++i)
        _cut.at.push_back({subdomain.part.xy[2 * i], subdomain.part.xy[2 * i + 1]});
      _cut.first_triangle.push_back(static_cast<std::int32_t>(_cut.triangle.size()));
      _cut.first_copy.push_back(static_cast<std::int32_t>(_cut.at.size()));
    }
  }

  std::int32_t side_of(const mesh::EdgeUse& use) const {
    const std::int32_t* node = &_mesh.triangles[3 * at(use.triangle)];
    const auto from = static_cast<std::int32_t>(std::find(node, node + 3, use.from) - node);
    return previous(3 * _place[at(use.triangle)] + from);
  }

  std::int32_t add_face(std::int32_t side, Condition condition, std::int32_t inclusion = -1) {
    const auto number = static_cast<std::int32_t>(_cut.faces.size());
    _cut.faces.push_back({side, condition, inclusion, -1, -1});
    _across[at(side)] = -1 - number;
    return number;
  }

  void find_faces() {
    constexpr std::int32_t nothing = INT32_MIN;
    _across.assign(_cut.copy.size(), nothing);
    for (const mesh::Interface& line : _mesh.interfaces)
      for (std::size_t i = 0; i < line.kind.size(); ++i)
        if (line.kind[i] != mesh::Kind::glue) cut_edge(line, i);
    for (const auto& [a, b] : _mesh.dirichlet)
      for (const mesh::EdgeUse& use : _edges.find(a, b)) add_face(side_of(use), Condition::free);
    // Neumann faces are numbered in the order of ddm::NeumannBoundary.
    std::vector<std::vector<std::int32_t>> neumann(_decomposition.subdomains.size());
    std::size_t turn = 0;
    _edges.each([&](std::span<const mesh::EdgeUse> uses) {
      stop::look_at_turn(turn++, cutting);
      const std::int32_t side = side_of(uses[0]);
      if (_across[at(side)] != nothing) return;
      if (uses.size() == 1) {
        neumann[at(_mesh.subdomain[at(uses[0].triangle)])].push_back(side);
        return;
      }
      const std::int32_t other = side_of(uses[1]);
      _across[at(side)] = other;
      _across[at(other)] = side;
    });
    std::int32_t number = 0;
    for (const std::vector<std::int32_t>& of_subdomain : neumann)
      for (const std::int32_t side : of_subdomain)
        _cut.faces[at(add_face(side, Condition::given))].traction = number++;
  }

  void find_chords() {
    for (const mesh::ChordEdge& edge : _mesh.chords) {
      ChordEdge& found = _cut.chords.emplace_back(ChordEdge{edge, {}});
      for (const mesh::EdgeUse& use : _edges.find(edge.a, edge.b)) {
        const std::int32_t side = side_of(use), across = _across[at(side)];
        found.beside[use.from == edge.a ? 0 : 1] = {side, across < 0 ? -1 - across : -1};
      }
    }
  }

  void find_ways_out() {
    std::vector<bool> found(_cut.triangle.size(), false);
    const auto lead = [&](std::int32_t side, std::int32_t into) {
      if (found[at(side / 3)]) return;
      found[at(side / 3)] = true;
      _cut.ways_out.push_back({side, into});
    };
    _cut.ways_out.reserve(_cut.triangle.size());
    for (const Face& face : _cut.faces)
      if (face.condition == Condition::free && face.inclusion < 0) lead(face.side, -1);
    for (std::size_t i = 0; i < _cut.ways_out.size(); ++i) {
      stop::look_at_turn<stop::quick>(i, cutting);
      const std::int32_t first = _cut.ways_out[i].side / 3 * 3;
      for (std::int32_t side = first; side < first + 3; ++side)
        if (_across[at(side)] >= 0) lead(_across[at(side)], side);
    }
  }

  void cut_edge(const mesh::Interface& line, std::size_t i) {
    const std::span<const mesh::EdgeUse> uses = _edges.find(line.nodes[i], line.nodes[i + 1]);
    const std::size_t on_left = uses[0].from == line.nodes[i] ? 0 : 1;
    Condition plus = Condition::free, minus = Condition::free;
    switch (line.kind[i]) {
      case mesh::Kind::crack:
        plus = Condition::crack_plus;
        minus = Condition::crack_minus;
        break;
      case mesh::Kind::delaminated:
        minus = Condition::pressed;
        break;
      case mesh::Kind::free:
        plus = minus = Condition::given;
        break;
      case mesh::Kind::glue:
      case mesh::Kind::inclusion:
        break;
    }
    const std::int32_t up = add_face(side_of(uses[on_left]), plus, line.inclusion[i]);
    const std::int32_t down = add_face(side_of(uses[1 - on_left]), minus, line.inclusion[i]);
    _cut.faces[at(up)].other = down;
    _cut.faces[at(down)].other = up;
  }

  /// The corner of the same node across the side before (clockwise) or after this corner; -1 - face
  /// if a face is there.
  std::int32_t clockwise(std::int32_t corner) const {
    const std::int32_t side = _across[at(previous(corner))];
    return side < 0 ? side : previous(side);
  }
  std::int32_t counterclockwise(std::int32_t corner) const {
    const std::int32_t side = _across[at(next(corner))];
    return side < 0 ? side : next(side);
  }

  bool is_crack(std::int32_t face) const {
    const Condition condition = _cut.faces[at(face)].condition;
    return condition == Condition::crack_minus || condition == Condition::crack_plus;
  }

  /// The first corner of the fan of a corner. The fan begins at a face that is not of a crack; a
  /// fan that goes all round begins at a crack if it has one, else anywhere.
  std::int32_t first_of(std::int32_t corner) const {
    std::int32_t behind_crack = -1;
    for (std::int32_t now = corner;;) {
      std::int32_t before = clockwise(now);
      if (before < 0) {
        const std::int32_t face = -1 - before;
        if (!is_crack(face)) return now;
        behind_crack = now;
        before = previous(_cut.faces[at(_cut.faces[at(face)].other)].side);  // its end 1
      }
      if (before == corner) return behind_crack >= 0 ? behind_crack : corner;
      now = before;
    }
  }

  void add_stop(std::size_t first, std::int32_t face, std::int32_t end) {
    const auto spoke = static_cast<std::int32_t>(_cut.corners.size() - first);
    _cut.stops.push_back({spoke, face, end});
  }

  void find_fans() {
    std::vector<bool> seen(_cut.copy.size(), false);
    _cut.corners.reserve(_cut.copy.size());
    _cut.first_corner.push_back(0);
    _cut.first_stop.push_back(0);
    for (std::size_t corner = 0; corner < seen.size(); ++corner) {
      stop::look_at_turn(corner, cutting);
      if (seen[corner]) continue;
      const std::int32_t begin = first_of(static_cast<std::int32_t>(corner));
      const std::size_t first = _cut.corners.size();
      if (const std::int32_t before = clockwise(begin); before < 0) add_stop(first, -1 - before, 0);
      for (std::int32_t now = begin;;) {
        seen[at(now)] = true;
        _cut.corners.push_back(now);
        std::int32_t after = counterclockwise(now);
        if (after < 0) {
          const std::int32_t face = -1 - after;
          add_stop(first, face, 1);
          if (!is_crack(face)) break;
          const std::int32_t other = _cut.faces[at(face)].other;
          after = next(_cut.faces[at(other)].side);  // its end 0 is this node
          if (after != begin) add_stop(first, other, 0);
        }
        if (after == begin) break;
        now = after;
      }
      _cut.first_corner.push_back(static_cast<std::int32_t>(_cut.corners.size()));
      _cut.first_stop.push_back(static_cast<std::int32_t>(_cut.stops.size()));
    }
  }

  /// Sorts the fans by blocks.
  void sort_fans(std::size_t block) {
    const std::size_t blocks = block_count(_cut.triangle_count(), block);
    _cut.first_fan.assign(blocks + 2, 0);
    std::vector<std::int32_t> block_of;  // per triangle
    for (std::size_t b = 0; b < blocks; ++b)
      block_of.resize(_cut.first_of_block(b + 1), static_cast<std::int32_t>(b));
    std::vector<std::vector<std::int32_t>> fans(blocks + 1);
    for (std::size_t fan = 0; fan < _cut.fan_count(); ++fan) {
      stop::look_at_turn(fan, cutting);
      const std::span<const std::int32_t> corners = corners_of(fan);
      const std::int32_t first = block_of[at(corners.front() / 3)];
      const bool alone = std::ranges::all_of(
          corners, [&](std::int32_t corner) { return block_of[at(corner / 3)] == first; });
      fans[alone ? at(first) : blocks].push_back(static_cast<std::int32_t>(fan));
    }
    std::vector<std::int32_t> first_corner{0}, corners, first_stop{0};
    std::vector<Stop> stops;
    corners.reserve(_cut.corners.size());
    for (std::size_t b = 0; b <= blocks; ++b) {
      stop::look(cutting);
      for (const std::int32_t fan : fans[b]) {
        const std::span<const std::int32_t> own = corners_of(at(fan));
        corners.insert(corners.end(), own.begin(), own.end());
        first_corner.push_back(static_cast<std::int32_t>(corners.size()));
        const std::span<const Stop> met = stops_of(at(fan));
        stops.insert(stops.end(), met.begin(), met.end());
        first_stop.push_back(static_cast<std::int32_t>(stops.size()));
      }
      _cut.first_fan[b + 1] = static_cast<std::int32_t>(first_corner.size()) - 1;
    }
    _cut.first_corner = std::move(first_corner);
    _cut.corners = std::move(corners);
    _cut.first_stop = std::move(first_stop);
    _cut.stops = std::move(stops);
  }

  void meet_triangles() {
    std::vector<char> seen(_cut.triangle_count(), 0);
    _cut.met.reserve(seen.size());
    _cut.met_until.reserve(_cut.fan_count());
    const auto meet = [&](std::size_t t) {
      if (std::exchange(seen[t], 1) == 0) _cut.met.push_back(static_cast<std::int32_t>(t));
    };
    for (std::size_t b = 0; b <= _cut.block_count(); ++b) {
      stop::look(cutting);
      for (auto fan = at(_cut.first_fan[b]); fan < at(_cut.first_fan[b + 1]); ++fan) {
        for (const std::int32_t corner : corners_of(fan)) meet(at(corner / 3));
        _cut.met_until.push_back(static_cast<std::int32_t>(_cut.met.size()));
      }
      if (b == _cut.block_count()) break;
      for (std::size_t t = _cut.first_of_block(b); t < _cut.first_of_block(b + 1); ++t) meet(t);
    }
  }

  std::span<const std::int32_t> corners_of(std::size_t fan) const {
    return std::span(_cut.corners)
        .subspan(at(_cut.first_corner[fan]),
                 at(_cut.first_corner[fan + 1] - _cut.first_corner[fan]));
  }

  std::span<const Stop> stops_of(std::size_t fan) const {
    return std::span(_cut.stops)
        .subspan(at(_cut.first_stop[fan]), at(_cut.first_stop[fan + 1] - _cut.first_stop[fan]));
  }

  /// Inclusions that share nodes are one body, with the first unknown of their displacement as its
  /// name.
  std::int32_t body_of(std::int32_t inclusion) const {
    if (inclusion < 0) return -1;
    return _decomposition.skeleton.motions[at(inclusion)].displacement.front().index;
  }

  /// Finds contact of two rigid bodies, or of one with the boundary, in a single node where the
  /// sides of the delaminated inclusion lie in two fans: the force between the bodies is then in
  /// neither fan.
  void find_obstacle() {
    std::vector<std::int32_t> ends(_mesh.node_count(), 0);
    for (std::size_t fan = 0; fan < _cut.fan_count() && _cut.obstacle.empty(); ++fan) {
      stop::look_at_turn(fan, cutting);
      const std::span<const Stop> stops = stops_of(fan);
      const auto has = [&](const auto& what) {
        return std::ranges::any_of(
            stops, [&](const Stop& stop) { return what(_cut.faces[at(stop.face)]); });
      };
      std::int32_t pressed_by = -1;
      has([&](const Face& face) {
        if (face.condition == Condition::pressed) pressed_by = body_of(face.inclusion);
        return false;
      });
      const bool held_by_another =
          pressed_by >= 0 && has([&](const Face& face) {
            return face.condition == Condition::free && body_of(face.inclusion) != pressed_by;
          });
      if (!held_by_another) continue;
      const std::int32_t corner = _cut.corners[at(_cut.first_corner[fan])];
      const auto node = at(_mesh.triangles[3 * at(_cut.triangle[at(corner / 3)]) + at(corner % 3)]);
      if (++ends[node] < 2) continue;
      _cut.obstacle = fmt::format(
          "there is no bound where a delaminated inclusion lies on another rigid one, as at {}; "
          "let "
          "them cross elsewhere",
          errors::shown(_mesh.xy[2 * node], _mesh.xy[2 * node + 1]));
    }
  }

  const mesh::Mesh& _mesh;
  const ddm::Decomposition& _decomposition;
  mesh::EdgeTable _edges;
  std::vector<std::int32_t> _place;   // T of each triangle of the mesh
  std::vector<std::int32_t> _across;  // per side: the side of the neighbour, or -1 - face
  CutMesh _cut;
};

}  // namespace

std::size_t CutMesh::bytes() const noexcept {
  const auto of = [](const auto& values) { return values.capacity() * sizeof(values[0]); };
  return shapes.bytes() + of(first_triangle) + of(first_copy) + of(copy) + of(at) + of(triangle) +
         of(faces) + of(chords) + of(ways_out) + of(first_corner) + of(corners) + of(first_stop) +
         of(stops) + of(first_fan) + of(met) + of(met_until) + of(ways.bodies) + of(ways.of);
}

CutMesh cut_mesh(const mesh::Mesh& mesh, const ddm::Decomposition& decomposition,
                 std::size_t block) {
  Cutting cutting(mesh, decomposition);
  CutMesh cut = cutting(block);
  std::vector<const fem::Tension*> tension;
  for (const ddm::Subdomain& subdomain : decomposition.subdomains)
    tension.push_back(&subdomain.tension);
  if (cut.obstacle.empty()) {
    cut.shapes =
        shapes({cut.copy, cut.at, cut.first_triangle, tension}, {cut.first_corner, cut.corners});
    cut.ways = ways(cut, cutting.across(), decomposition.skeleton);
  }
  return cut;
}

}  // namespace anticrack::estimate
