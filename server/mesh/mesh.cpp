// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/mesh.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "base/at.hpp"
#include "errors/errors.hpp"
#include "mesh/edges.hpp"
#include "mesh/geometry_primitives.hpp"
#include "stop/stop.hpp"

namespace anticrack::mesh {
namespace {

using EdgeKey = std::pair<std::int32_t, std::int32_t>;

EdgeKey key(std::int32_t a, std::int32_t b) noexcept { return {std::min(a, b), std::max(a, b)}; }

template <class... Parts>
[[noreturn]] void fail(const Parts&... parts) {
  std::ostringstream text;
  text.precision(8);
  (text << ... << parts);
  throw errors::Error(errors::Reason::mesh_invalid, text.str());
}

std::string where(const Mesh& mesh, std::int32_t node) {
  const auto [x, y] = position(mesh, node);
  return fmt::format("node {} ({:g}, {:g})", node, x, y);
}

std::string where_edge(const Mesh& mesh, std::int32_t a, std::int32_t b) {
  return "the edge from " + where(mesh, a) + " to " + where(mesh, b);
}

void check_shapes(const Mesh& mesh) {
  constexpr auto limit = at(std::numeric_limits<std::int32_t>::max());
  if (mesh.xy.size() % 2 != 0) fail("xy has ", mesh.xy.size(), " numbers; it takes two a node");
  if (mesh.triangles.size() % 3 != 0)
    fail("triangles has ", mesh.triangles.size(), " indices; it takes three a triangle");
  if (mesh.triangles.empty()) fail("the mesh has no triangle");
  if (mesh.node_count() > limit || mesh.triangle_count() > limit) {
    fail("the mesh has ", mesh.node_count(), " nodes and ", mesh.triangle_count(),
         " triangles; at most ", limit, " fit the indices");
  }
  if (mesh.subdomain.size() != mesh.triangle_count()) {
    fail("subdomain has ", mesh.subdomain.size(), " entries for ", mesh.triangle_count(),
         " triangles");
  }
}

void check_nodes(const Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.xy.size(); ++i) {
    stop::look_at_turn<std::size_t{1} << 20>(i, "checking a mesh");
    if (!std::isfinite(mesh.xy[i]))
      fail(i % 2 == 0 ? "x" : "y", " of node ", i / 2, " is ", mesh.xy[i], ", not a finite number");
  }
}

void check_triangles(const Mesh& mesh) {
  const auto nodes = static_cast<std::int32_t>(mesh.node_count());
  const auto subdomains = static_cast<std::int32_t>(mesh.subdomains.size());
  std::vector<bool> node_used(mesh.node_count(), false);
  std::vector<bool> subdomain_used(mesh.subdomains.size(), false);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    stop::look_at_turn<stop::quick>(t, "checking a mesh");
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::int32_t node = mesh.triangles[3 * t + corner];
      if (node < 0 || node >= nodes)
        fail("triangle ", t, " has node ", node, "; the nodes are 0 to ", nodes - 1);
      node_used[at(node)] = true;
    }
    const std::int32_t s = mesh.subdomain[t];
    if (s < 0 || s >= subdomains)
      fail("triangle ", t, " is in subdomain ", s, "; there are ", subdomains);
    subdomain_used[at(s)] = true;
    const double size = area(mesh, t);
    // written so that NaN fails as well
    if (!(size > 0)) {
      fail("triangle ", t, " at ", where(mesh, mesh.triangles[3 * t]), " has area ", size,
           "; its nodes must run counterclockwise around a positive area");
    }
  }
  for (std::size_t s = 0; s < subdomain_used.size(); ++s)
    if (!subdomain_used[s])
      fail("subdomain ", s, " (\"", mesh.subdomains[s], "\") has no triangle");
  for (std::size_t n = 0; n < node_used.size(); ++n)
    if (!node_used[n]) fail(where(mesh, static_cast<std::int32_t>(n)), " belongs to no triangle");
}

void check_tension(const Mesh& mesh) {
  if (!mesh.tension.empty() && mesh.tension.size() != mesh.subdomains.size()) {
    fail("tension has ", mesh.tension.size(), " entries for ", mesh.subdomains.size(),
         " subdomains; it takes one each, or none at all");
  }
  for (std::size_t s = 0; s < mesh.tension.size(); ++s) {
    if (!(mesh.tension[s] > 0) || !std::isfinite(mesh.tension[s])) {
      fail("tension of subdomain ", s, " (\"", mesh.subdomains[s], "\") is ", mesh.tension[s],
           "; it takes a finite number above 0");
    }
  }
}

void check_laws(const Mesh& mesh) {
  if (!mesh.tension_laws.empty() && mesh.tension_laws.size() != mesh.subdomains.size()) {
    fail("tension_laws has ", mesh.tension_laws.size(), " entries for ", mesh.subdomains.size(),
         " subdomains; it takes one each, or none at all");
  }
  for (std::size_t s = 0; s < mesh.tension_laws.size(); ++s) {
    if (mesh.tension_laws[s] == TensionLaw()) continue;
    const std::string fault = fault_of(mesh.tension_laws[s]);
    if (!fault.empty()) fail("subdomain ", s, " (\"", mesh.subdomains[s], "\"): ", fault);
  }
}

void check_motions(const Mesh& mesh) {
  if (!mesh.motions.empty() && mesh.motions.size() != mesh.inclusions.size()) {
    fail("motions has ", mesh.motions.size(), " entries for ", mesh.inclusions.size(),
         " inclusions; it takes one each, or none at all");
  }
  for (std::size_t j = 0; j < mesh.motions.size(); ++j) {
    const std::string fault = fault_of(mesh.motions[j]);
    if (!fault.empty()) fail("inclusion ", j, " (\"", mesh.inclusions[j], "\"): ", fault);
  }
}

/// Sorts edges; throws if one occurs twice.
void sort_once(const Mesh& mesh, std::vector<EdgeKey>& edges, const char* fault) {
  std::ranges::sort(edges);
  const auto twice = std::ranges::adjacent_find(edges);
  if (twice != edges.end()) fail(where_edge(mesh, twice->first, twice->second), fault);
}

bool needs_inclusion(Kind kind) noexcept {
  return kind == Kind::inclusion || kind == Kind::delaminated;
}

void check_interface_shape(const Mesh& mesh, const Interface& interface) {
  const std::string& name = interface.name;
  if (interface.nodes.size() < 2)
    fail("interface \"", name, "\" has ", interface.nodes.size(), " nodes; it takes two at least");
  const std::size_t edges = interface.nodes.size() - 1;
  if (interface.kind.size() != edges || interface.inclusion.size() != edges) {
    fail("interface \"", name, "\" has ", edges, " edges, but ", interface.kind.size(),
         " kinds and ", interface.inclusion.size(), " inclusion indices");
  }
  for (std::size_t i = 0; i < interface.nodes.size(); ++i) {
    const std::int32_t node = interface.nodes[i];
    if (node < 0 || at(node) >= mesh.node_count()) {
      fail("interface \"", name, "\" has node ", node, " at place ", i, "; the nodes are 0 to ",
           mesh.node_count() - 1);
    }
  }
  for (std::size_t i = 0; i < edges; ++i) {
    const auto number = static_cast<std::int32_t>(interface.kind[i]);
    if (number < static_cast<std::int32_t>(Kind::glue) ||
        number > static_cast<std::int32_t>(Kind::free))
      fail("edge ", i, " of interface \"", name, "\" has kind ", number, "; the kinds are 1 to 5");
    const std::int32_t j = interface.inclusion[i];
    if (j < -1 || j >= static_cast<std::int32_t>(mesh.inclusions.size())) {
      fail("edge ", i, " of interface \"", name, "\" has inclusion ", j, "; there are ",
           mesh.inclusions.size());
    }
    if (needs_inclusion(interface.kind[i]) != (j >= 0)) {
      fail("edge ", i, " of interface \"", name, "\" has kind ", number, " and inclusion ", j,
           "; kinds 3 and 4 take an inclusion, the others -1");
    }
  }
}

/// Checks the interfaces; returns the edges of all, sorted.
std::vector<EdgeKey> check_interfaces(const Mesh& mesh, const EdgeTable& edges) {
  std::vector<EdgeKey> seen;
  for (const Interface& interface : mesh.interfaces) {
    check_interface_shape(mesh, interface);
    for (std::size_t i = 0; i + 1 < interface.nodes.size(); ++i) {
      const std::int32_t a = interface.nodes[i];
      const std::int32_t b = interface.nodes[i + 1];
      const auto uses = edges.find(a, b);
      if (uses.size() != 2) {
        fail(where_edge(mesh, a, b), " of interface \"", interface.name, "\" belongs to ",
             uses.size(), " triangles; it takes one on each side");
      }
      const auto left = mesh.subdomain[at(uses[0].triangle)];
      const auto right = mesh.subdomain[at(uses[1].triangle)];
      if (left == right && interface.kind[i] == Kind::glue) {
        fail(where_edge(mesh, a, b), " of interface \"", interface.name,
             "\" is glue and has subdomain ", left,
             " on both sides; inside one subdomain only a crack or an inclusion is an interface");
      }
      seen.push_back(key(a, b));
    }
  }
  sort_once(mesh, seen, " lies on the interfaces more than once");
  return seen;
}

void check_edges(const Mesh& mesh, const EdgeTable& edges, const std::vector<EdgeKey>& interfaces) {
  std::size_t turn = 0;
  edges.each([&](std::span<const EdgeUse> uses) {
    stop::look_at_turn<stop::quick>(turn++, "checking a mesh");
    const EdgeUse& first = uses[0];
    if (uses.size() > 2)
      fail(where_edge(mesh, first.low(), first.high()), " belongs to ", uses.size(),
           " triangles; a plane mesh has two at most");
    if (uses.size() < 2) return;
    if (first.from == uses[1].from)
      fail("triangles ", first.triangle, " and ", uses[1].triangle, " lie on the same side of ",
           where_edge(mesh, first.low(), first.high()), ": they overlap");
    const auto s = mesh.subdomain[at(first.triangle)];
    const auto other = mesh.subdomain[at(uses[1].triangle)];
    if (s != other &&
        !std::binary_search(interfaces.begin(), interfaces.end(), key(first.from, first.to)))
      fail(where_edge(mesh, first.low(), first.high()), " between subdomains ", s, " and ", other,
           " lies on no interface");
  });
}

void check_boundary(const Mesh& mesh, const EdgeTable& edges) {
  std::vector<EdgeKey> seen;
  seen.reserve(mesh.dirichlet.size());
  const auto nodes = static_cast<std::int32_t>(mesh.node_count());
  for (std::size_t i = 0; i < mesh.dirichlet.size(); ++i) {
    const auto [a, b] = mesh.dirichlet[i];
    if (a < 0 || a >= nodes || b < 0 || b >= nodes) {
      fail("dirichlet edge ", i, " joins nodes ", a, " and ", b, "; the nodes are 0 to ",
           nodes - 1);
    }
    const auto uses = edges.find(a, b);
    if (uses.size() != 1) {
      fail("dirichlet edge ", i, ", ", where_edge(mesh, a, b), ", belongs to ", uses.size(),
           " triangles; an edge of the boundary belongs to one");
    }
    seen.push_back(key(a, b));
  }
  sort_once(mesh, seen, " is listed as dirichlet twice");
  for (const BoundaryPart& part : mesh.boundary_parts)
    for (const std::int32_t node : {part.first, part.last})
      if (node < 0 || node >= nodes)
        fail("boundary part ", part.name, " ends at node ", node, "; the nodes are 0 to ",
             nodes - 1);
}

void check_chords(const Mesh& mesh, const EdgeTable& edges) {
  for (std::size_t i = 0; i < mesh.chords.size(); ++i) {
    const auto& [a, b, at_a, at_middle, at_b, chord, stretch] = mesh.chords[i];
    if (edges.find(a, b).empty())
      fail("edge ", i, " on a chord joins nodes ", a, " and ", b, ", which no triangle does");
    if (!std::isfinite(at_a + at_middle + at_b + stretch) || !(chord > 0))
      fail("edge ", i, " on a chord, ", where_edge(mesh, a, b),
           ", has numbers that are not finite");
  }
}

}  // namespace

std::string fault_of(const TensionLaw& law) {
  if (law.along.empty()) return "the tension along is empty; give an expression in x and y";
  if (std::isfinite(law.angle) && std::abs(law.angle) <= 360) return "";
  return "the angle of the tension is " + shown(law.angle) + "; give degrees from -360 to 360";
}

std::string fault_of(const Motion& motion) {
  if (!motion.fixed) return "";
  if (!std::isfinite(*motion.fixed))
    return "it is fixed at " + shown(*motion.fixed) + "; give a finite displacement";
  if (!motion.tilt) return "";
  return "it is fixed at " + shown(*motion.fixed) +
         " and tilts; an inclusion that is held does not tilt, so leave one of the two out";
}

double area(const Mesh& mesh, std::size_t triangle) noexcept {
  const Point a = corner(mesh, triangle, 0);
  const Point b = corner(mesh, triangle, 1);
  const Point c = corner(mesh, triangle, 2);
  return 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
}

std::vector<double> arc_length(const Mesh& mesh, const Interface& interface) {
  std::vector<double> s(interface.nodes.size(), 0.0);
  for (std::size_t i = 1; i < s.size(); ++i) {
    s[i] = s[i - 1] +
           distance(position(mesh, interface.nodes[i - 1]), position(mesh, interface.nodes[i]));
  }
  return s;
}

void validate(const Mesh& mesh) {
  check_shapes(mesh);
  check_nodes(mesh);
  check_triangles(mesh);
  check_tension(mesh);
  check_laws(mesh);
  check_motions(mesh);
  const EdgeTable edges(mesh.triangles);
  check_edges(mesh, edges, check_interfaces(mesh, edges));
  check_boundary(mesh, edges);
  check_chords(mesh, edges);
}

Mesh without_triangles(const Mesh& mesh) {
  Mesh result;
  result.subdomains = mesh.subdomains;
  result.tension = mesh.tension;
  result.tension_laws = mesh.tension_laws;
  result.inclusions = mesh.inclusions;
  result.motions = mesh.motions;
  result.warnings = mesh.warnings;
  result.bends = mesh.bends;
  result.boundary_parts = mesh.boundary_parts;
  return result;
}

}  // namespace anticrack::mesh
