// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/at.hpp"
#include "mesh/geometry_primitives.hpp"
#include "mesh/geometry_steps.hpp"

namespace anticrack::mesh {
namespace {

constexpr std::size_t most_names = 20;  ///< most names in one message

/// A part of the outer boundary, by a parameter that runs through its lines one after the other.
/// `end` may lie past the last line.
struct Placed {
  double begin = 0;
  double end = 0;
  Field field;
};

class Neumann {
 public:
  Neumann(const Geometry& geometry, Network& network)
      : _geometry(geometry), _network(network), _names(side_names(geometry)) {
    for (std::size_t l = 0; l < network.outer; ++l)
      _first.push_back(_first.back() + network.lines[l].line.spans());
  }

  void add_part(std::size_t i) {
    const Field field = indexed("neumann", i);
    const Part& part = _geometry.neumann[i];
    const double begin = place(mark(_network, part.from), part.from, field + ".from");
    double end = place(mark(_network, part.to), part.to, field + ".to");
    if (end <= begin) end += total();
    if (end - begin < total()) check_direction(part, begin, end, field);
    _placed.push_back({begin, end, field});
  }

  void add_name(std::size_t i) {
    const Field field = indexed("neumann_sides", i);
    const std::string& name = _geometry.neumann_sides[i];
    const auto found = std::ranges::find(_names, name);
    if (found == _names.end()) refuse_name(name, field);
    const auto index = static_cast<std::size_t>(found - _names.begin());
    const std::size_t outer = _names.size() - _geometry.holes.size();
    if (index < outer) {
      const auto [begin, end] = side(index);
      _placed.push_back({begin, end, field});
      return;
    }
    const std::size_t line = _network.outer + index - outer;
    for (const Stretch& other : _stretches)
      if (other.line == static_cast<int>(line))
        refuse(field, field, " names \"", name, "\" again; leave it out");
    _stretches.push_back({static_cast<int>(line), 0, double(_network.lines[line].line.spans())});
  }

  std::vector<Stretch> take() {
    std::ranges::stable_sort(_placed, {}, &Placed::begin);
    for (std::size_t i = 0; i < _placed.size(); ++i) {
      add_stretches(_placed[i]);
      if (_placed.size() == 1) break;
      const Placed& next = _placed[(i + 1) % _placed.size()];
      const double shift = i + 1 == _placed.size() ? total() : 0;
      if (next.begin + shift < _placed[i].end)
        refuse(next.field, next.field, " and ", _placed[i].field, " overlap; make them one part");
    }
    return std::move(_stretches);
  }

 private:
  double total() const { return _first.back(); }

  /// The parameter of a point of the network that must be on the outer boundary.
  double place(int point, const Point& p, const Field& field) const {
    double off = -1;
    for (std::size_t l = 0; l < _network.outer; ++l) {
      const Line& line = _network.lines[l].line;
      if (const double t = station_of(_network.lines[l], point); t >= 0)
        return std::fmod(_first[l] + t, total());
      const double d = line.distance_to(p);
      off = off < 0 ? d : std::min(off, d);
    }
    refuse(field, field, " ", shown(p), " lies ", shown(off),
           " off the boundary; it must lie on it, to ", shown(snap_distance(_network)));
  }

  /// The parameters of the side with this index in the user's order.
  std::pair<double, double> side(std::size_t index) const {
    if (_geometry.sides.empty()) {
      const std::size_t n = _geometry.boundary.size();
      const auto edge = static_cast<double>(_network.turned ? (2 * n - 2 - index) % n : index);
      return {edge, edge + 1};
    }
    const std::size_t line = _network.turned ? _network.outer - 1 - index : index;
    return {_first[line], _first[line + 1]};
  }

  /// The line at a parameter of the boundary, and the parameter of that line.
  std::pair<const Line*, double> at_parameter(double t) const {
    t = std::fmod(t, total());
    std::size_t l = 0;
    while (l + 1 < _network.outer && _first[l + 1] <= t) ++l;
    return {&_network.lines[l].line, t - _first[l]};
  }
  Point point(double t) const {
    const auto [line, own] = at_parameter(t);
    return line->at(own);
  }

  /// Whether the boundary runs straight from one parameter to another.
  bool straight(double begin, double end) const {
    const Segment chord{point(begin), point(end)};
    for (double t = std::floor(begin); t < end; ++t) {
      if (!at_parameter(t).first->straight()) return false;
      if (t > begin && distance(point(t), chord) > _network.tolerance) return false;
    }
    return true;
  }

  /// Refuses what is probably one side written clockwise, which would silently mean all the others.
  void check_direction(const Part& part, double begin, double end, const Field& field) const {
    const bool vertices = begin == std::floor(begin) && end == std::floor(end);
    if (!vertices || straight(begin, end) || !straight(end, begin + total())) return;
    std::string name;
    for (std::size_t i = 0; i < _names.size() - _geometry.holes.size(); ++i) {
      const auto [first, last] = side(i);
      if (first == std::fmod(end, total()) && last - first == begin + total() - end)
        name = "its name, \"" + _names[i] + "\", or ";
    }
    refuse(field, field, " from ", shown(part.from), " to ", shown(part.to),
           ", walked counterclockwise, is all of the boundary but the straight side between them; "
           "for that side write ",
           name, "[", shown(part.to), ", ", shown(part.from), "], for the others their names");
  }

  [[noreturn]] void refuse_name(const std::string& name, const Field& field) const {
    std::string all;
    for (std::size_t i = 0; i < std::min(_names.size(), most_names); ++i)
      all += (i == 0 ? "" : ", ") + _names[i];
    const bool printable = std::ranges::all_of(name, [](char c) { return c >= ' ' && c <= '~'; });
    refuse(field, "neumann names no side or hole",
           printable && name.size() <= 64 ? ": \"" + name + "\"" : "", "; there are ", all,
           _names.size() > most_names ? ", ..." : "");
  }

  /// Adds a part as stretches, line by line.
  void add_stretches(const Placed& placed) {
    for (const double shift : {0.0, total()}) {
      for (std::size_t l = 0; l < _network.outer; ++l) {
        const double first = _first[l] + shift;
        const double begin = std::max(placed.begin, first);
        const double end = std::min(placed.end, _first[l + 1] + shift);
        if (begin < end)
          _stretches.push_back({static_cast<int>(l), begin - first, end - first, Kind::glue, -1});
      }
    }
  }

  const Geometry& _geometry;
  Network& _network;
  std::vector<std::string> _names;
  std::vector<double> _first{0};  ///< the parameter at which each line begins, and the total
  std::vector<Placed> _placed;
  std::vector<Stretch> _stretches;
};

}  // namespace

std::vector<Stretch> lay_neumann(const Geometry& geometry, Network& network) {
  Neumann neumann(geometry, network);
  for (std::size_t i = 0; i < geometry.neumann.size(); ++i) neumann.add_part(i);
  for (std::size_t i = 0; i < geometry.neumann_sides.size(); ++i) neumann.add_name(i);
  return neumann.take();
}

}  // namespace anticrack::mesh
