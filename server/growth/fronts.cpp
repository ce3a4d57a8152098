// SPDX-License-Identifier: GPL-3.0-or-later
#include "growth/fronts.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/at.hpp"
#include "errors/errors.hpp"
#include "expression/function.hpp"
#include "mesh/edges.hpp"

namespace anticrack::growth {
namespace {

using errors::Error;
using errors::Reason;
using mesh::Kind;

/// An interface edge at one of its nodes.
struct Incident {
  std::size_t interface, edge;
  Kind kind;
  std::int32_t inclusion;
};

bool is_open(Kind kind) { return kind == Kind::crack || kind == Kind::delaminated; }

std::string shown(const mesh::Point& x) { return errors::shown(x[0], x[1]); }

std::string shown(const Path& path) {
  return fmt::format("the path on \"{}\" from {} to {}", path.interface, shown(path.from),
                     shown(path.to));
}

class Finder {
 public:
  explicit Finder(const mesh::Mesh& mesh)
      : _mesh(mesh),
        _incident(mesh.node_count()),
        _on_boundary(mesh::EdgeTable(mesh.triangles).boundary_nodes(mesh.node_count())),
        _on_dirichlet(mesh.node_count(), 0) {
    for (std::size_t i = 0; i < mesh.interfaces.size(); ++i) {
      const mesh::Interface& line = mesh.interfaces[i];
      for (std::size_t e = 0; e < line.kind.size(); ++e)
        for (const std::int32_t node : {line.nodes[e], line.nodes[e + 1]})
          _incident[at(node)].push_back({i, e, line.kind[e], line.inclusion[e]});
    }
    for (const auto& edge : mesh.dirichlet)
      for (const std::int32_t node : edge) _on_dirichlet[at(node)] = 1;
  }

  void add(const Path& path, Fronts& all) const {
    Stretch stretch = place(path, all.stretches);
    const mesh::Interface& line = _mesh.interfaces[stretch.interface];
    const std::vector<double> arc = mesh::arc_length(_mesh, line);
    const End first = end_of(stretch, stretch.first), last = end_of(stretch, stretch.last);
    stretch.holds_before = first == End::holds;
    stretch.holds_beyond = last == End::holds;
    const auto starts = [](End end) { return end == End::front || end == End::open_end; };
    if (!starts(first) && !starts(last)) {
      throw Error(Reason::invalid_argument,
                  "nothing open meets {}, so no front starts there: let it begin where the "
                  "inclusion has come off or the crack ends",
                  shown(path));
    }
    std::array<std::pair<std::ptrdiff_t, double>, 2> ends{{{-1, 0}, {-1, 0}}};
    for (const bool forward : {true, false})
      if ((forward ? first : last) == End::open_end)
        ends[forward ? 0 : 1] = leave(path, forward, stretch);
    const Track from_first = track_of(path, stretch, arc);
    const auto add_front = [&](bool forward, End beyond, int facing) {
      const auto [end, length] = ends[forward ? 0 : 1];
      Front front{all.stretches.size(), forward, from_first, end, length};
      if (!forward) {
        std::ranges::reverse(front.track.position);
        std::ranges::reverse(front.track.place);
        std::ranges::reverse(front.track.toughness);
      }
      front.track.breaks_through = beyond != End::holds;
      front.track.facing = facing;
      (forward ? stretch.forward : stretch.backward) = static_cast<int>(all.fronts.size());
      all.fronts.push_back(std::move(front));
    };
    const auto count = static_cast<int>(all.fronts.size());
    const bool both = starts(first) && starts(last);
    if (starts(first)) add_front(true, last, both ? count + 1 : -1);
    if (starts(last)) add_front(false, first, both ? count : -1);
    all.stretches.push_back(stretch);
  }

 private:
  /// open_end: of a delaminated inclusion, which a crack leaves.
  enum class End { front, open_end, holds, breaks_through };

  /// Lets a stretch begin where its front is far enough from the delaminated end for G to be
  /// computed. The node of the end, and the distance.
  std::pair<std::ptrdiff_t, double> leave(const Path& path, bool forward, Stretch& stretch) const {
    const mesh::Interface& line = _mesh.interfaces[stretch.interface];
    const auto place = [&](std::size_t i) { return mesh::position(_mesh, line.nodes[i]); };
    const auto far = [](const mesh::Point& a, const mesh::Point& b) {
      return std::hypot(a[0] - b[0], a[1] - b[1]);
    };
    std::size_t& here = forward ? stretch.first : stretch.last;
    const std::size_t end = here;
    while (stretch.first + 1 < stretch.last) {
      const std::size_t behind = here;
      forward ? ++here : --here;
      const double length = far(place(here), place(end));
      if (length >= least_radius * far(place(here), place(behind)))
        return {static_cast<std::ptrdiff_t>(end), length};
    }
    throw Error(
        Reason::invalid_argument,
        "{} leaves the end of an inclusion that has come off, and is followed from where it "
        "is ten edges long: take a finer mesh along it, or a longer path",
        shown(path));
  }

  /// The node of an interface that is nearest to a point, which may be an edge's length away.
  std::size_t nearest(const Path& path, const mesh::Interface& line, const mesh::Point& x) const {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity(), edge = 0;
    for (std::size_t i = 0; i < line.nodes.size(); ++i) {
      const mesh::Point node = mesh::position(_mesh, line.nodes[i]);
      const double far = std::hypot(x[0] - node[0], x[1] - node[1]);
      if (i > 0) {
        const mesh::Point before = mesh::position(_mesh, line.nodes[i - 1]);
        edge = std::max(edge, std::hypot(node[0] - before[0], node[1] - before[1]));
      }
      if (!(far < least)) continue;
      least = far;
      best = i;
    }
    if (!(least <= edge)) {
      throw Error(Reason::invalid_argument,
                  "{} leaves its interface, from which {} is {} away: write points of it",
                  shown(path), shown(x), errors::shown(least));
    }
    return best;
  }

  Stretch place(const Path& path, const std::vector<Stretch>& before) const {
    const auto found = std::ranges::find(_mesh.interfaces, path.interface, &mesh::Interface::name);
    if (found == _mesh.interfaces.end()) {
      std::string names;
      for (const mesh::Interface& line : _mesh.interfaces)
        names += (names.empty() ? "\"" : ", \"") + line.name + "\"";
      throw Error(Reason::invalid_argument, "the mesh has no interface \"{}\"; it has {}",
                  path.interface, names.empty() ? "none" : names);
    }
    Stretch stretch;
    stretch.interface = at(found - _mesh.interfaces.begin());
    stretch.first = nearest(path, *found, path.from);
    stretch.last = nearest(path, *found, path.to);
    if (stretch.first > stretch.last) std::swap(stretch.first, stretch.last);
    if (stretch.first == stretch.last)
      throw Error(Reason::invalid_argument,
                  "{} is shorter than an edge of the mesh: take a finer mesh", shown(path));
    for (const Stretch& other : before)
      if (other.interface == stretch.interface && stretch.first <= other.last &&
          other.first <= stretch.last)
        throw Error(Reason::invalid_argument,
                    "{} overlaps or touches another: write one, with Gc an expression in x and y",
                    shown(path));
    const Kind kind = found->kind[stretch.first];
    for (std::size_t e = stretch.first; e < stretch.last; ++e) {
      if (!is_open(found->kind[e]) || found->kind[e] != kind ||
          found->inclusion[e] != found->inclusion[stretch.first])
        throw Error(Reason::invalid_argument,
                    "{} is not of one condition on the mesh, a crack or delaminated, at {}: end it "
                    "there, and let the mesh have as open what may come off",
                    shown(path), shown(mesh::position(_mesh, found->nodes[e])));
      if (e > stretch.first && _incident[at(found->nodes[e])].size() > 2)
        throw Error(Reason::invalid_argument, "{} crosses another interface at {}: end it there",
                    shown(path), shown(mesh::position(_mesh, found->nodes[e])));
    }
    return stretch;
  }

  /// What lies beyond an end of a stretch.
  End end_of(const Stretch& stretch, std::size_t index) const {
    const mesh::Interface& line = _mesh.interfaces[stretch.interface];
    const auto node = at(line.nodes[index]);
    const bool at_first = index == stretch.first;
    const std::size_t own = at_first ? stretch.first : stretch.last - 1;
    const Kind kind = line.kind[own];
    if (_on_boundary[node]) return _on_dirichlet[node] != 0 ? End::holds : End::breaks_through;
    const std::vector<Incident>& here = _incident[node];
    const bool rigid = kind == Kind::delaminated;
    if (here.size() == 1) return rigid ? End::breaks_through : End::holds;
    if (here.size() == 2) {
      const Incident& other =
          here[here[0].interface == stretch.interface && here[0].edge == own ? 1 : 0];
      const bool same = other.inclusion == line.inclusion[own];
      const bool beside = at_first ? other.edge + 1 == own : other.edge == own + 1;
      if (other.interface == stretch.interface && beside && other.kind == kind && same)
        return End::front;
      if (rigid) return other.kind == Kind::inclusion && same ? End::holds : End::breaks_through;
      return other.kind == Kind::delaminated ? End::open_end : End::holds;
    }
    const bool meets_open = std::ranges::any_of(here, [&](const Incident& other) {
      return (other.interface != stretch.interface || other.edge != own) && is_open(other.kind);
    });
    return meets_open ? End::breaks_through : End::holds;
  }

  Track track_of(const Path& path, const Stretch& stretch, const std::vector<double>& arc) const {
    const mesh::Interface& line = _mesh.interfaces[stretch.interface];
    const expression::Function toughness(path.toughness, "toughness");
    Track track;
    track.name = path.interface;
    for (std::size_t i = stretch.first; i <= stretch.last; ++i) {
      const mesh::Point x = mesh::position(_mesh, line.nodes[i]);
      const double Gc = toughness(x[0], x[1]);
      if (!(Gc > 0)) {
        throw Error(Reason::invalid_argument,
                    "Gc = {} is {} at {}; it must be above 0 on the whole path", path.toughness,
                    errors::shown(Gc), shown(x))
            .at("toughness");
      }
      track.position.push_back(arc[i]);
      track.place.push_back(x);
      track.toughness.push_back(Gc);
    }
    return track;
  }

  const mesh::Mesh& _mesh;
  std::vector<std::vector<Incident>> _incident;  // (nodes)
  std::vector<bool> _on_boundary;
  std::vector<char> _on_dirichlet;
};

}  // namespace

Fronts find_fronts(const mesh::Mesh& mesh, std::span<const Path> paths) {
  const Finder finder(mesh);
  Fronts all;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    try {
      finder.add(paths[i], all);
    } catch (Error& error) {
      if (error.fields().empty()) error.at("");
      error.below(fmt::format("paths[{}]", i));
      throw;
    }
  }
  if (all.fronts.empty())
    throw Error(Reason::invalid_argument, "growth needs at least one path").at("paths");
  return all;
}

}  // namespace anticrack::growth
