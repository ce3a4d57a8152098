// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/elimination_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <limits>
#include <optional>
#include <utility>

#include "base/at.hpp"
#include "base/at_once.hpp"
#include "ddm/vertex_separator.hpp"
#include "stop/stop.hpp"

namespace anticrack::ddm {
namespace {

constexpr const char* ordering = "ordering the unknowns of a mesh";

struct Node {
  double x, y;
  float reach, reach_x, reach_y;  // greatest distance of a neighbour, in all and along each axis
  std::int32_t vertex;
};

/// Line or circle where the halves of a set meet, at distance `middle` along an axis or from a
/// centre.
struct Cut {
  enum class Shape : char { across_x, across_y, circle };
  Shape shape = Shape::across_x;
  double x = 0, y = 0;
  double middle = 0;

  /// Signed distance from the cut; that of a neighbour differs by at most the node's reach.
  double distance(const Node& node) const {
    switch (shape) {
      case Shape::across_x:
        return node.x - middle;
      case Shape::across_y:
        return node.y - middle;
      case Shape::circle:
        break;
    }
    const double dx = node.x - x, dy = node.y - y;
    return std::sqrt(dx * dx + dy * dy) - middle;
  }
  double reach(const Node& node) const {
    switch (shape) {
      case Shape::across_x:
        return node.reach_x;
      case Shape::across_y:
        return node.reach_y;
      case Shape::circle:
        break;
    }
    return node.reach;
  }
};

/// Nodes first..last-1 of the order; all of them belong to `part`.
struct Set {
  std::size_t first, last;
  std::int32_t part;
  Node finest;  ///< the node whose neighbours are nearest

  std::size_t size() const { return last - first; }
};

/// Tells whether a circle meets a node, without a square root.
class Circle {
 public:
  explicit Circle(const Cut& cut) : _cut(cut), _square(cut.middle * cut.middle) {}

  /// Whether the node lies inside and may have a neighbour that does not.
  bool meets(const Node& node) const {
    const double dx = node.x - _cut.x, dy = node.y - _cut.y, square = dx * dx + dy * dy;
    const double inner = _cut.middle - static_cast<double>(node.reach);
    return (square < _square) & ((inner <= 0) | (square >= inner * inner));
  }

 private:
  const Cut& _cut;
  double _square;
};

/// The nodes, of which each set has a range. Neighbours of a set's nodes are in it or in
/// separators, which stay, so threads may work on sets at once.
struct Order {
  Order(const Graph& of, std::span<const double> xy)
      : graph(of), part(of.size(), 0), moved(of.size()) {
    nodes.reserve(graph.size());
    for (std::size_t v = 0; v < graph.size(); ++v) {
      stop::look_at_turn<stop::quick>(v, ordering);
      double square = 0, reach_x = 0, reach_y = 0;
      for (std::int32_t e = graph.begin[v]; e < graph.begin[v + 1]; ++e) {
        const std::size_t u = at(graph.neighbour[at(e)]);
        const double dx = xy[2 * u] - xy[2 * v], dy = xy[2 * u + 1] - xy[2 * v + 1];
        square = std::max(square, dx * dx + dy * dy);
        reach_x = std::max(reach_x, std::abs(dx));
        reach_y = std::max(reach_y, std::abs(dy));
      }
      nodes.push_back({xy[2 * v], xy[2 * v + 1], rounded_up(std::sqrt(square)), rounded_up(reach_x),
                       rounded_up(reach_y), static_cast<std::int32_t>(v)});
    }
  }

  static float rounded_up(double reach) { return static_cast<float>(reach * (1 + 1e-6)); }

  const Graph& graph;
  std::vector<Node> nodes;         // in the order of elimination, as far as it is known
  std::vector<std::int32_t> part;  // of each vertex, or `separator`
  std::vector<Node> moved;         // workspace, of each set in its range
};

bool finer(const Node& a, const Node& b) { return a.reach < b.reach; }

/// Works on one set after the other.
class Dissection {
 public:
  /// New parts have numbers above `parts`.
  Dissection(Order& order, std::int32_t parts)
      : _graph(order.graph),
        _nodes(order.nodes),
        _part(order.part),
        _moved(order.moved),
        _local(order.graph.size(), -1),
        _parts(parts) {}

  void order(const Set& whole) {
    std::vector<Set> open = {whole};
    std::size_t turn = 0;
    while (!open.empty()) {
      stop::look_at_turn<16>(turn++, ordering);
      const Set set = open.back();
      open.pop_back();
      if (const auto halves = divide(set)) open.insert(open.end(), {halves->first, halves->second});
    }
  }

  /// Divides a set that is too large to be ordered; nothing if it has been ordered.
  std::optional<std::pair<Set, Set>> divide(const Set& set) {
    if (set.size() <= SmallGraph::most) {
      order_leaf(set);
      return {};
    }
    halve(set);
    const auto halves = move_apart(set);
    // A set that cannot be halved, such as a complete graph, keeps its order.
    if (halves.first.size() == 0 || halves.second.size() == 0) return {};
    return halves;
  }

  std::int32_t parts() const { return _parts; }

 private:
  static constexpr std::int32_t separator = -1;

  /// The median distance of the nodes from the cut, estimated from a sample.
  double median(const Set& set, const Cut& cut) {
    // Small sets are many, and sampling them cost more than a better median saves.
    const std::size_t count = std::clamp<std::size_t>(set.size() / 8, 31, 127);
    _sample.clear();
    for (std::size_t i = 0; i < count; ++i)
      _sample.push_back(cut.distance(_nodes[set.first + i * set.size() / count]));
    const auto middle = _sample.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(_sample.begin(), middle, _sample.end());
    return *middle;
  }

  /// The cut that meets the fewest nodes, of two lines and a circle. Meshes are graded towards
  /// points, and circles around such points meet few nodes.
  Cut choose(const Set& set) {
    std::array<Cut, 3> cuts;
    for (const Cut::Shape shape :
         {Cut::Shape::across_x, Cut::Shape::across_y, Cut::Shape::circle}) {
      Cut& cut = cuts[static_cast<std::size_t>(shape)];
      cut = {shape, set.finest.x, set.finest.y, 0};
      cut.middle = median(set, cut);
    }
    const Circle circle(cuts[2]);
    std::array<std::ptrdiff_t, 3> met{};
    for (std::size_t i = set.first; i < set.last; ++i) {
      stop::look_at_turn<stop::quick>(i, ordering);
      const Node& node = _nodes[i];
      const double x = node.x - cuts[0].middle, y = node.y - cuts[1].middle;
      met[0] += (x < 0) & (x + static_cast<double>(node.reach_x) >= 0);
      met[1] += (y < 0) & (y + static_cast<double>(node.reach_y) >= 0);
      met[2] += circle.meets(node);
    }
    return cuts[at(std::min_element(met.begin(), met.end()) - met.begin())];
  }

  /// Gives each node of the set its new part.
  void halve(const Set& set) {
    const Cut cut = choose(set);
    const std::int32_t first = _parts + 1, second = _parts + 2;
    _parts += 2;
    std::ptrdiff_t in_first = 0;
    _near.clear();
    for (std::size_t i = set.first; i < set.last; ++i) {
      stop::look_at_turn<stop::quick>(i, ordering);
      const Node& node = _nodes[i];
      const double distance = cut.distance(node);
      _part[at(node.vertex)] = distance < 0 ? first : second;
      in_first += distance < 0 ? 1 : 0;
      if (std::abs(distance) <= cut.reach(node)) _near.push_back(node.vertex);
    }
    find_band(first, second, {in_first, static_cast<std::ptrdiff_t>(set.size()) - in_first});
  }

  void take(std::int32_t vertex) {
    _local[at(vertex)] = static_cast<std::int32_t>(_taken.size());
    _taken.push_back(vertex);
  }

  void find_band(std::int32_t first, std::int32_t second, std::array<std::ptrdiff_t, 2> sizes) {
    _taken.clear();
    std::array<std::ptrdiff_t, 2> in_band{};
    for (const std::int32_t v : _near) {
      const std::int32_t mine = _part[at(v)], other = mine == first ? second : first;
      for (std::int32_t e = _graph.begin[at(v)]; e < _graph.begin[at(v) + 1]; ++e) {
        if (_part[at(_graph.neighbour[at(e)])] == other) {
          take(v);
          ++in_band[mine == first ? 0 : 1];
          break;
        }
      }
    }
    if (_taken.empty()) return;
    const std::size_t size = at(sizes[0] + sizes[1]);
    const std::size_t at_cut = _taken.size();
    const std::array<std::ptrdiff_t, 2> in_cut = in_band;
    std::size_t done = 0;
    for (int layer = 0; layer < layers(size); ++layer) {
      const std::size_t end = _taken.size();
      const std::array<bool, 2> full = {4 * in_band[0] >= sizes[0], 4 * in_band[1] >= sizes[1]};
      for (; done < end; ++done) {
        const std::int32_t v = _taken[done], mine = _part[at(v)];
        if (full[mine == first ? 0 : 1]) continue;
        for (std::int32_t e = _graph.begin[at(v)]; e < _graph.begin[at(v) + 1]; ++e) {
          const std::int32_t u = _graph.neighbour[at(e)];
          if (_part[at(u)] == mine && _local[at(u)] < 0) {
            take(u);
            ++in_band[mine == first ? 0 : 1];
          }
        }
      }
    }
    const bool whole_side = in_band[0] == sizes[0] || in_band[1] == sizes[1];
    if (whole_side) {  // nothing would be left to part: choose among the ends of cut edges
      for (; _taken.size() > at_cut; _taken.pop_back()) _local[at(_taken.back())] = -1;
      in_band = in_cut;
    }
    connect_band(first, whole_side);
    const std::vector<Part>& part =
        _separate.find(_band, sizes[0] - in_band[0], sizes[1] - in_band[1]);
    for (std::size_t i = 0; i < _taken.size(); ++i) {
      const std::size_t v = at(_taken[i]);
      _local[v] = -1;
      _part[v] = part[i] == Part::first ? first : (part[i] == Part::second ? second : separator);
    }
  }

  void connect_band(std::int32_t first, bool all_meet) {
    _band.begin.assign(1, 0);
    _band.neighbour.clear();
    _band.meets_first.assign(_taken.size(), 0);
    _band.meets_second.assign(_taken.size(), 0);
    for (std::size_t i = 0; i < _taken.size(); ++i) {
      const std::size_t v = at(_taken[i]);
      char outer = all_meet ? 1 : 0;
      for (std::int32_t e = _graph.begin[v]; e < _graph.begin[v + 1]; ++e) {
        const std::size_t u = at(_graph.neighbour[at(e)]);
        if (_local[u] >= 0)
          _band.neighbour.push_back(_local[u]);
        else if (_part[u] == _part[v])
          outer = 1;
      }
      _band.begin.push_back(static_cast<std::int32_t>(_band.neighbour.size()));
      (_part[v] == first ? _band.meets_first : _band.meets_second)[i] = outer;
    }
  }

  /// Layers of nodes around the cut in which the separator is sought. The separators of large sets
  /// cause the most fill and are few, so more layers pay.
  static int layers(std::size_t size) { return size > 4096 ? 6 : 1; }

  /// Reorders the set into first part, second part and separator; returns the two parts.
  std::pair<Set, Set> move_apart(const Set& set) {
    const std::int32_t first = _parts - 1, second = _parts;
    std::size_t end = set.first, seconds = 0;
    _on_separator.clear();
    std::array<Node, 2> finest;
    finest[0].reach = finest[1].reach = std::numeric_limits<float>::infinity();
    for (std::size_t i = set.first; i < set.last; ++i) {
      stop::look_at_turn<stop::quick>(i, ordering);
      const Node& node = _nodes[i];
      const std::int32_t part = _part[at(node.vertex)];
      if (part == first) {
        finest[0] = finer(node, finest[0]) ? node : finest[0];
        _nodes[end++] = node;
      } else if (part == second) {
        finest[1] = finer(node, finest[1]) ? node : finest[1];
        _moved[set.first + seconds++] = node;
      } else {
        _on_separator.push_back(node);
      }
    }
    const auto middle = std::copy_n(_moved.begin() + static_cast<std::ptrdiff_t>(set.first),
                                    seconds, _nodes.begin() + static_cast<std::ptrdiff_t>(end));
    std::copy(_on_separator.begin(), _on_separator.end(), middle);
    return {{set.first, end, first, finest[0]}, {end, end + seconds, second, finest[1]}};
  }

  void order_leaf(const Set& set) {
    SmallGraph small;
    small.size = set.size();
    for (std::size_t i = 0; i < small.size; ++i)
      _local[at(_nodes[set.first + i].vertex)] = static_cast<std::int32_t>(i);
    _taken.clear();  // the nodes around the leaf, as many as there is room for
    constexpr auto most = static_cast<std::int32_t>(SmallGraph::most);
    constexpr std::uint64_t one = 1;
    for (std::size_t i = 0; i < small.size; ++i) {
      small.inside[i] = one << i;
      const std::size_t v = at(_nodes[set.first + i].vertex);
      for (std::int32_t e = _graph.begin[v]; e < _graph.begin[v + 1]; ++e) {
        const std::int32_t u = _graph.neighbour[at(e)];
        std::int32_t& local = _local[at(u)];
        if (local < 0 && _taken.size() < SmallGraph::most) {
          local = most + static_cast<std::int32_t>(_taken.size());
          _taken.push_back(u);
        }
        if (local >= most)
          small.around[i] |= one << (local - most);
        else if (local >= 0)
          small.inside[i] |= one << local;
      }
    }
    std::array<std::int32_t, SmallGraph::most> order{};
    for (std::size_t i = 0; i < small.size; ++i) {
      _moved[set.first + i] = _nodes[set.first + i];
      _local[at(_nodes[set.first + i].vertex)] = -1;
    }
    for (const std::int32_t u : _taken) _local[at(u)] = -1;
    minimum_degree(small, order);
    for (std::size_t i = 0; i < small.size; ++i)
      _nodes[set.first + i] = _moved[set.first + at(order[i])];
  }

  const Graph& _graph;
  std::vector<Node>& _nodes;
  std::vector<std::int32_t>& _part;
  std::vector<Node>& _moved;
  std::vector<std::int32_t> _local;  // number of each vertex in the present band or leaf, or -1
  std::int32_t _parts;
  VertexSeparator _separate;
  Band _band;
  // Workspace.
  std::vector<std::int32_t> _near, _taken;
  std::vector<double> _sample;
  std::vector<Node> _on_separator;
};

}  // namespace

std::vector<std::int32_t> nested_dissection(const Graph& graph, std::span<const double> xy,
                                            int threads) {
  Order all(graph, xy);
  const auto finest = std::min_element(all.nodes.begin(), all.nodes.end(), finer);
  std::deque<Set> open;
  if (finest != all.nodes.end()) open.push_back({0, all.nodes.size(), 0, *finest});
  Dissection first(all, 0);
  const std::size_t enough = threads > 1 ? 2 * at(threads) : 1;
  while (!open.empty() && open.size() < enough) {
    if (const auto halves = first.divide(open.front()))
      open.insert(open.end(), {halves->first, halves->second});
    open.pop_front();
  }
  base::at_once(open.size(), threads, [&] {
    return [&, own = Dissection(all, first.parts())](std::size_t i) mutable { own.order(open[i]); };
  });
  std::vector<std::int32_t> result;
  result.reserve(all.nodes.size());
  for (const Node& node : all.nodes) result.push_back(node.vertex);
  return result;
}

}  // namespace anticrack::ddm
