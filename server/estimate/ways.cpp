// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/ways.hpp"

#include <algorithm>
#include <map>

#include "base/at.hpp"
#include "estimate/cut_mesh.hpp"
#include "stop/stop.hpp"

namespace anticrack::estimate {
namespace {

class Search {
 public:
  Search(const CutMesh& cut, std::span<const std::int32_t> across, const ddm::Skeleton& skeleton)
      : _cut(cut), _across(across), _skeleton(skeleton), _way(cut.triangle_count(), Ways::none) {}

  Ways operator()() {
    find_bodies();
    for (const Face& face : _cut.faces)
      if (face.condition == Condition::free && (face.inclusion < 0 || body_of(face).held))
        reach(at(face.side / 3), 0);
    for (double base = 0; !_queue.empty();) {
      spread(base);
      base = 0;
      for (std::size_t b = 0; b < _ways.bodies.size(); ++b) base = std::max(base, hand_on(b));
      if (base == 0) break;
    }
    const bool all = _possible && std::ranges::none_of(_ways.bodies, [](const Ways::Body& body) {
                       return !body.held && !std::isfinite(body.force + body.moment);
                     });
    _ways.triangle = all ? *std::ranges::max_element(_way) : Ways::none;
    return std::move(_ways);
  }

 private:
  Ways::Body& body_of(const Face& face) { return _ways.bodies[at(_ways.of[at(face.inclusion)])]; }

  double cost(std::size_t t) const {
    double largest = 0;
    for (std::size_t i = 3 * t; i < 3 * t + 3; ++i)
      largest = std::max(largest, dot(_cut.shapes.edge[i], _cut.shapes.edge[i]));
    const double below = _cut.shapes.variation.empty() ? 1 : _cut.shapes.variation[t].below;
    return largest * below * below;
  }

  Vector end_of(const Face& face, std::size_t end) const {
    return _cut.at[at(_cut.ends(face)[end])];
  }

  double from_body(const Ways::Body& body, const Vector& x) const {
    return std::hypot(x[0] - body.from[0], x[1] - body.from[1]);
  }

  // Breadth-first step; _way holds a square until its triangle leaves the queue.

  void reach(std::size_t t, double squared) {
    if (std::isfinite(_way[t])) return;
    _way[t] = squared + cost(t);
    _queue.push_back(t);
  }

  void spread(double base) {
    for (; _next < _queue.size(); ++_next) {
      stop::look_at_turn<std::size_t{1} << 14>(_next, "looking for ways out of a membrane");
      const std::size_t t = _queue[_next];
      const double squared = _way[t];
      for (std::size_t side = 3 * t; side < 3 * t + 3; ++side)
        if (_across[side] >= 0) reach(at(_across[side] / 3), squared);
      _way[t] = base + std::sqrt(squared);
    }
  }

  /// Passes through a body to triangles around it that have no way yet. Returns the longest way up
  /// to the body; 0 if it has no way, or no such triangle.
  double hand_on(std::size_t b) {
    Ways::Body& body = _ways.bodies[b];
    if (body.held) return 0;
    std::vector<std::size_t> beyond;
    for (const std::int32_t f : _faces[b]) {
      const Face& face = _cut.faces[at(f)];
      const auto t = at(face.side / 3);
      if (!std::isfinite(_way[t])) {
        beyond.push_back(t);
        continue;
      }
      const Vector p = end_of(face, 0), q = end_of(face, 1);
      const double lever = from_body(body, {(p[0] + q[0]) / 2, (p[1] + q[1]) / 2});
      body.force = std::min(body.force, _way[t] + (body.moment > 0 ? lever * body.moment : 0));
    }
    const double way = body.force + body.extent * body.moment;
    if (!std::isfinite(way)) return 0;
    for (const std::size_t t : beyond) reach(t, 0);
    return beyond.empty() ? 0 : way;
  }

  void find_bodies() {
    std::map<std::int32_t, std::int32_t> number;
    std::vector<const ddm::RigidMotion*> first;  // of each body
    for (const ddm::RigidMotion& motion : _skeleton.motions) {
      const std::int32_t displacement = motion.displacement.front().index;
      const auto [found, is_new] =
          number.try_emplace(displacement, static_cast<std::int32_t>(_ways.bodies.size()));
      _ways.of.push_back(found->second);
      if (!is_new) continue;
      _ways.bodies.emplace_back();
      first.push_back(&motion);
    }
    _faces.resize(_ways.bodies.size());
    std::vector<std::vector<Vector>> nodes(_ways.bodies.size());
    for (std::size_t f = 0; f < _cut.faces.size(); ++f) {
      const Face& face = _cut.faces[f];
      if (face.inclusion < 0) continue;
      const auto b = at(_ways.of[at(face.inclusion)]);
      if (face.condition == Condition::free) _faces[b].push_back(static_cast<std::int32_t>(f));
      nodes[b].push_back(end_of(face, 0));
      nodes[b].push_back(end_of(face, 1));
    }
    for (std::size_t b = 0; b < first.size(); ++b) describe(b, *first[b], nodes[b]);
  }

  /// Whether the unknown is free and a value of its own, which no other unknown determines.
  bool is_free(std::int32_t unknown) const {
    const ddm::Row& row = _skeleton.rows[at(unknown)];
    return row.free.size() == 1 && row.jumps.empty() && row.held.empty();
  }
  bool is_held(std::int32_t unknown) const {
    const ddm::Row& row = _skeleton.rows[at(unknown)];
    return row.free.empty() && row.jumps.empty();
  }

  void describe(std::size_t b, const ddm::RigidMotion& motion, const std::vector<Vector>& nodes) {
    Ways::Body& body = _ways.bodies[b];
    std::map<std::int32_t, Vector> axes;
    for (const ddm::Term& term : motion.slope_x) axes[term.index][0] += term.factor;
    for (const ddm::Term& term : motion.slope_y) axes[term.index][1] += term.factor;
    const std::int32_t displacement = motion.displacement.front().index;
    bool free = is_free(displacement);
    body.held = is_held(displacement);
    for (const auto& [unknown, axis] : axes) {
      free = free && is_free(unknown);
      body.held = body.held && is_held(unknown);
    }
    _possible = _possible && (free || body.held) && !nodes.empty();
    if (body.held || nodes.empty()) return;
    body.from = nodes.front();
    Vector far = body.from;
    for (const Vector& x : nodes)
      if (from_body(body, x) > from_body(body, far)) far = x;
    body.extent = from_body(body, far);
    if (axes.empty()) return;
    if (axes.size() == 1) {
      const Vector axis = axes.begin()->second;
      const double size = std::hypot(axis[0], axis[1]);
      body.along = {axis[0] / size, axis[1] / size};
      body.slope = 2 / body.extent;
    } else {
      body.slope = Ways::none;
      for (const Vector& x : nodes) {
        const double cross = std::abs((far[0] - body.from[0]) * (x[1] - body.from[1]) -
                                      (far[1] - body.from[1]) * (x[0] - body.from[0]));
        if (cross > 0)
          body.slope = std::min(body.slope, 2 * (body.extent + from_body(body, x)) / cross);
      }
    }
    body.moment = cost_of_moment(b);
  }

  double cost_of_moment(std::size_t b) const {
    struct Turn {
      double cost = Ways::none;
      Vector direction{};
    };
    std::vector<Turn> turns;
    Turn best;
    for (const std::int32_t f : _faces[b]) {
      const Face& face = _cut.faces[at(f)];
      const Vector p = end_of(face, 0), q = end_of(face, 1);
      const double length = std::hypot(q[0] - p[0], q[1] - p[1]);
      turns.push_back({6 * std::sqrt(cost(at(face.side / 3))) / length,
                       {(q[0] - p[0]) / length, (q[1] - p[1]) / length}});
      if (turns.back().cost < best.cost) best = turns.back();
    }
    if (_ways.bodies[b].along) return best.cost;
    double both = Ways::none;
    for (const Turn& other : turns) {
      const double sine =
          std::abs(best.direction[0] * other.direction[1] - best.direction[1] * other.direction[0]);
      if (sine > 0) both = std::min(both, (best.cost + other.cost) / sine);
    }
    return both;
  }

  const CutMesh& _cut;
  std::span<const std::int32_t> _across;
  const ddm::Skeleton& _skeleton;
  std::vector<double> _way;
  std::vector<std::size_t> _queue;
  std::size_t _next = 0;
  std::vector<std::vector<std::int32_t>> _faces;  // per body: faces that any flux may pass
  bool _possible = true;
  Ways _ways;
};

}  // namespace

Ways ways(const CutMesh& cut, std::span<const std::int32_t> across, const ddm::Skeleton& skeleton) {
  return Search(cut, across, skeleton)();
}

}  // namespace anticrack::estimate
