// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry_steps.hpp"

#include <fmt/core.h>

#include <limits>
#include <optional>

#include "mesh/geometry_primitives.hpp"

namespace anticrack::mesh {
namespace {

constexpr std::size_t most_warnings = 100;

class Snap {
 public:
  Snap(const Network& network, std::vector<std::string>& warnings)
      : _network(network), _reach(snap_distance(network)), _warnings(warnings) {}

  /// Moves a point onto a line for which `holds` is true, unless one passes through it already.
  /// Throws geometry_invalid for a point that is not finite.
  template <class Holds>
  void move(Point& p, const Field& field, const Holds& holds, const char* which = "") {
    check_point(p, field);
    double least = std::numeric_limits<double>::infinity();
    Point to{};
    for (std::size_t l = 0; l < _network.lines.size(); ++l) {
      const Line& line = _network.lines[l].line;
      if (!holds(l)) continue;
      const std::optional<double> t = line.locate(p, _reach);
      if (!t) continue;
      if (line.locate(p, _network.tolerance)) return;
      if (const double off = distance(p, line.at(*t)); off < least) {
        least = off;
        to = line.at(*t);
      }
    }
    if (least > _reach) return;
    if (_moved < most_warnings) {
      _warnings.push_back(field.shown + which + " " + shown(p) + " lies " + shown(least) +
                          " off its line; " + shown(to) + " is taken");
    }
    ++_moved;
    p = to;
  }

  void move_part(Part& part, const Field& field) {
    const auto interface = [&](std::size_t l) { return _network.lines[l].role == Role::interface; };
    move(part.from, field + ".from", interface);
    move(part.to, field + ".to", interface);
  }

  bool finish() {
    if (_moved > most_warnings)
      _warnings.push_back(fmt::format("and {} more such points", _moved - most_warnings));
    return _moved > 0;
  }

 private:
  const Network& _network;
  const double _reach;
  std::vector<std::string>& _warnings;
  std::size_t _moved = 0;
};

}  // namespace

double snap_distance(const Network& network) noexcept {
  return network.tolerance * (snap_reach / relative_tolerance);
}

bool snap_ends(const Network& network, Drawn& geometry, std::vector<std::string>& warnings) {
  Snap snap(network, warnings);
  for (std::size_t i = 0; i < geometry.interfaces.size(); ++i) {
    InterfaceSpec& spec = geometry.interfaces[i];
    if (spec.closed) continue;
    const std::size_t own = network.boundary + i;
    const auto other = [&](std::size_t l) {
      return l != own && network.lines[l].role != Role::align;
    };
    const Field& field = network.lines[own].field;
    snap.move(spec.points.front(), field, other, ", its first point");
    snap.move(spec.points.back(), field, other, ", its last point");
  }
  for (std::size_t i = 0; i < geometry.inclusions.size(); ++i) {
    InclusionSpec& inclusion = geometry.inclusions[i];
    const Field field("inclusion", i, inclusion.name);
    if (!inclusion.line) snap.move_part(inclusion.part, field.at(".part", ""));
    for (std::size_t k = 0; k < inclusion.delaminated.size() && k < max_vertices; ++k)
      snap.move_part(inclusion.delaminated[k], field.at(".delaminated_parts", "delaminated")[k]);
  }
  for (std::size_t i = 0; i < geometry.cracks.size(); ++i)
    if (!geometry.cracks[i].line)
      snap.move_part(geometry.cracks[i].part,
                     Field("crack", i, geometry.cracks[i].name).at(".part", ""));
  const auto boundary = [&](std::size_t l) { return l < network.outer; };
  for (std::size_t i = 0; i < geometry.neumann.size(); ++i) {
    snap.move(geometry.neumann[i].from, indexed("neumann", i) + ".from", boundary);
    snap.move(geometry.neumann[i].to, indexed("neumann", i) + ".to", boundary);
  }
  return snap.finish();
}

}  // namespace anticrack::mesh
