// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/import_steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

#include "base/union_find.hpp"
#include "mesh/edges.hpp"
#include "mesh/precision.hpp"
#include "mesher/messages.hpp"

namespace anticrack::mesher {
namespace {

/// Relative to the extent. gmsh integrates along curves, so the nodes of a line that is meshed from
/// either end differ by 3e-12.
constexpr double same_place = 1e-9;
/// Relative to the shortest rim edge, for meshes graded below `same_place`.
constexpr double same_place_of_edge = 1e-3;
/// Radians within which two edges from one node lie on each other. Opened notches are wider.
constexpr double same_direction = 1e-9;
/// Most of this angle when the rounding of short edges is added.
constexpr double widest_same_direction = 1e-3;

constexpr const char* matching_nodes =
    "both sides must have the same nodes along their common line (in gmsh: one curve for both "
    "surfaces, or Coherence, or the same Transfinite Curve on both)";

/// Coordinates of the nodes, and their geometry.
class Places {
 public:
  Places(std::span<const double> xy, std::span<const std::uint64_t> tags) : _xy(xy), _tags(tags) {
    double low[2] = {xy[0], xy[1]};
    double high[2] = {xy[0], xy[1]};
    for (std::size_t i = 0; i < xy.size(); ++i) {
      low[i % 2] = std::min(low[i % 2], xy[i]);
      high[i % 2] = std::max(high[i % 2], xy[i]);
    }
    _corner = {low[0], low[1]};
    const double extent = std::max(high[0] - low[0], high[1] - low[1]);
    const double largest = std::max({-low[0], -low[1], high[0], high[1]});
    _tolerance = std::max(same_place * extent, mesh::coordinate_rounding * largest);
  }

  double x(std::int32_t node) const { return _xy[2 * at(node)]; }
  double y(std::int32_t node) const { return _xy[2 * at(node) + 1]; }
  double distance(std::int32_t a, std::int32_t b) const {
    return std::hypot(x(b) - x(a), y(b) - y(a));
  }
  double angle(std::int32_t a, std::int32_t b) const {
    return std::atan2(y(b) - y(a), x(b) - x(a));
  }
  /// Nodes within this distance may lie at the same place.
  double tolerance() const { return _tolerance; }

  /// Cell of a grid whose neighbouring cells hold everything within `tolerance`.
  std::array<std::int64_t, 2> cell(std::int32_t node) const {
    const double width = 2 * _tolerance;
    return {static_cast<std::int64_t>((x(node) - _corner[0]) / width),
            static_cast<std::int64_t>((y(node) - _corner[1]) / width)};
  }

  std::string describe(std::int32_t node) const {
    return fmt::format("node {} ({:g}, {:g})", _tags[at(node)], x(node), y(node));
  }

 private:
  std::span<const double> _xy;
  std::span<const std::uint64_t> _tags;
  std::array<double, 2> _corner{};
  double _tolerance = 0;
};

/// An edge of one triangle; `low` and `high` represent all nodes at their places.
struct RimEdge {
  std::int32_t low = 0;
  std::int32_t high = 0;
  mesh::EdgeUse use;
  bool matched = false;
};

std::vector<RimEdge> rim_of(const mesh::EdgeTable& edges) {
  std::vector<RimEdge> rim;
  edges.each([&](std::span<const mesh::EdgeUse> uses) {
    if (uses.size() == 1) rim.push_back({uses[0].low(), uses[0].high(), uses[0], false});
  });
  return rim;
}

std::vector<std::int32_t> nodes_of(const std::vector<RimEdge>& rim) {
  std::vector<std::int32_t> nodes;
  nodes.reserve(2 * rim.size());
  for (const RimEdge& edge : rim) {
    nodes.push_back(edge.use.from);
    nodes.push_back(edge.use.to);
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

/// Unites nodes at the same place.
void find_coincident(const Places& places, const std::vector<RimEdge>& rim,
                     const std::vector<std::int32_t>& nodes, std::size_t node_count,
                     base::UnionFind& same) {
  std::vector<double> shortest(node_count, std::numeric_limits<double>::infinity());
  for (const RimEdge& edge : rim) {
    const double length = places.distance(edge.use.from, edge.use.to);
    for (const std::int32_t node : {edge.use.from, edge.use.to}) {
      double& known = shortest[at(node)];
      known = std::min(known, length);
    }
  }
  struct Entry {
    std::array<std::int64_t, 2> cell{};
    std::int32_t node = 0;
  };
  std::vector<Entry> entries;
  entries.reserve(nodes.size());
  for (const std::int32_t node : nodes) entries.push_back({places.cell(node), node});
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.cell, a.node) < std::tie(b.cell, b.node);
  });
  const auto compare = [&](const Entry& entry, std::array<std::int64_t, 2> cell) {
    auto other =
        std::lower_bound(entries.begin(), entries.end(), cell,
                         [](const Entry& e, const auto& wanted) { return e.cell < wanted; });
    for (; other != entries.end() && other->cell == cell; ++other) {
      const double bound = std::min(
          places.tolerance(),
          same_place_of_edge * std::min(shortest[at(entry.node)], shortest[at(other->node)]));
      if (places.distance(entry.node, other->node) <= bound) same.unite(entry.node, other->node);
    }
  };
  for (const Entry& entry : entries) {
    // only half of the neighbouring cells, as the other half find this cell
    const auto [i, j] = entry.cell;
    for (const auto& cell : {std::array{i, j}, std::array{i, j + 1}, std::array{i + 1, j - 1},
                             std::array{i + 1, j}, std::array{i + 1, j + 1}})
      compare(entry, cell);
  }
}

/// Marks pairs of edges at the same place; sorts the rim by (low, high).
void match(const Places& places, base::UnionFind& same, std::vector<RimEdge>& rim) {
  for (RimEdge& edge : rim) {
    const std::int32_t from = same.find(edge.use.from);
    const std::int32_t to = same.find(edge.use.to);
    edge.low = std::min(from, to);
    edge.high = std::max(from, to);
  }
  std::sort(rim.begin(), rim.end(), [](const RimEdge& a, const RimEdge& b) {
    return std::tie(a.low, a.high, a.use.triangle) < std::tie(b.low, b.high, b.use.triangle);
  });
  for (std::size_t i = 1; i < rim.size(); ++i) {
    RimEdge& a = rim[i - 1];
    RimEdge& b = rim[i];
    if (a.low != b.low || a.high != b.high) continue;
    const bool same_side = same.find(a.use.from) == same.find(b.use.from);
    if (a.matched || same_side) {
      refuse("triangles overlap at the edge from {} to {}: {}; mesh every surface once",
             places.describe(b.use.from), places.describe(b.use.to),
             same_side ? "two lie on the same side of it" : "more than two meet in it");
    }
    a.matched = b.matched = true;
  }
}

/// Refuses edges from one place in the same direction that are not a pair: hanging nodes.
void refuse_hanging(const Places& places, base::UnionFind& same, const std::vector<RimEdge>& rim) {
  struct Ray {
    std::int32_t place = 0;
    double angle = 0;
    double length = 0;
    std::int32_t from = 0;
    std::int32_t to = 0;
  };
  std::vector<Ray> rays;
  rays.reserve(2 * rim.size());
  for (const RimEdge& edge : rim) {
    if (edge.matched) continue;
    const auto [a, b, triangle] = edge.use;
    const double length = places.distance(a, b);
    rays.push_back({same.find(a), places.angle(a, b), length, a, b});
    rays.push_back({same.find(b), places.angle(b, a), length, b, a});
  }
  std::sort(rays.begin(), rays.end(), [](const Ray& a, const Ray& b) {
    return std::tie(a.place, a.angle, a.to) < std::tie(b.place, b.angle, b.to);
  });
  const auto check = [&](const Ray& a, const Ray& b, double turn) {
    const double rounding = places.tolerance() / std::min(a.length, b.length);
    if (turn > std::min(same_direction + rounding, widest_same_direction)) return;
    const auto& [shorter, longer] = a.length < b.length ? std::tie(a, b) : std::tie(b, a);
    refuse(
        "the edge from {} to {} lies on the edge from {} to {}, but they end at different nodes "
        "(hanging node); {}",
        places.describe(longer.from), places.describe(longer.to), places.describe(shorter.from),
        places.describe(shorter.to), matching_nodes);
  };
  for (std::size_t first = 0; first < rays.size();) {
    std::size_t last = first;
    while (last + 1 < rays.size() && rays[last + 1].place == rays[first].place) {
      check(rays[last], rays[last + 1], rays[last + 1].angle - rays[last].angle);
      ++last;
    }
    if (last > first)
      check(rays[last], rays[first], rays[first].angle + 2 * std::numbers::pi - rays[last].angle);
    first = last + 1;
  }
}

/// Nodes at the same place must belong to paired edges.
void refuse_touching(const Places& places, base::UnionFind& same, const std::vector<RimEdge>& rim,
                     const std::vector<std::int32_t>& nodes, std::size_t node_count) {
  std::vector<bool> met(node_count, false);
  for (const RimEdge& edge : rim) {
    if (!edge.matched) continue;
    met[at(edge.use.from)] = met[at(edge.use.to)] = true;
  }
  std::vector<std::int32_t> partner(node_count, -1);
  for (const std::int32_t node : nodes) {
    const std::int32_t first = same.find(node);
    if (first == node) continue;
    partner[at(node)] = first;
    partner[at(first)] = node;
  }
  for (const std::int32_t node : nodes) {
    const std::int32_t other = partner[at(node)];
    if (other < 0 || met[at(node)]) continue;
    refuse("{} lies on {}, but no edge of one lies on an edge of the other; {}",
           places.describe(node), places.describe(other), matching_nodes);
  }
}

Welding number(std::size_t node_count, base::UnionFind& same) {
  Welding welding;
  welding.node.reserve(node_count);
  for (std::size_t i = 0; i < node_count; ++i) {
    const auto node = static_cast<std::int32_t>(i);
    const std::int32_t first = same.find(node);
    // the first node of a place has its number already
    welding.node.push_back(first == node ? static_cast<std::int32_t>(welding.node_count++)
                                         : welding.node[at(first)]);
  }
  return welding;
}

}  // namespace

const DoubledEdge* Welding::find(std::int32_t a, std::int32_t b) const noexcept {
  const auto key = std::pair(std::min(a, b), std::max(a, b));
  const auto found = std::lower_bound(
      doubled.begin(), doubled.end(), key,
      [](const DoubledEdge& e, const auto& wanted) { return std::pair(e.low, e.high) < wanted; });
  const bool there = found != doubled.end() && std::pair(found->low, found->high) == key;
  return there ? &*found : nullptr;
}

Welding weld(std::span<const double> xy, std::span<const std::int32_t> triangles,
             std::span<const std::uint64_t> tags) {
  const std::size_t node_count = xy.size() / 2;
  const Places places(xy, tags);
  std::vector<RimEdge> rim = rim_of(mesh::EdgeTable(triangles));
  const std::vector<std::int32_t> nodes = nodes_of(rim);
  base::UnionFind same(node_count);
  find_coincident(places, rim, nodes, node_count, same);
  match(places, same, rim);
  refuse_hanging(places, same, rim);
  refuse_touching(places, same, rim, nodes, node_count);

  Welding welding = number(node_count, same);
  base::UnionFind joined(node_count);
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    joined.unite(triangles[i], triangles[i + 1]);
    joined.unite(triangles[i], triangles[i + 2]);
  }
  for (std::size_t i = 1; i < rim.size(); ++i) {
    const RimEdge& edge = rim[i];
    if (!edge.matched || edge.low != rim[i - 1].low || edge.high != rim[i - 1].high) continue;
    const auto low = welding.node[at(edge.low)];
    const auto high = welding.node[at(edge.high)];
    welding.doubled.push_back(
        {low, high, joined.find(edge.use.from) != joined.find(rim[i - 1].use.from)});
  }
  // numbers ascend with the first nodes, so the order of the rim is that of the welded edges
  return welding;
}

}  // namespace anticrack::mesher
