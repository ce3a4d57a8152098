// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/import.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>

#include "errors/errors.hpp"
#include "mesher/curve_groups.hpp"
#include "mesher/helper.hpp"
#include "mesher/interface_chains.hpp"
#include "mesher/msh_scanner.hpp"

namespace anticrack::mesher {
namespace {

using mesh::Kind;
using mesh::Mesh;

/// What a plane geometry that was rotated or scaled may leave in z, relative to its size.
constexpr double plane_tolerance = 1e-9;

[[noreturn]] void refuse(const std::string& message) {
  throw errors::Error(errors::Reason::mesh_invalid, message);
}

using NodeIndex = std::unordered_map<std::uint64_t, std::int32_t>;

/// Subdomain of each physical or elementary surface.
std::map<int, std::int32_t> read_subdomains(const MshFile& file, Mesh& mesh) {
  const bool grouped = std::any_of(file.triangles.begin(), file.triangles.end(),
                                   [](const auto& t) { return t.group != 0; });
  std::map<int, std::int32_t> subdomains;
  for (const auto& t : file.triangles) {
    if (grouped && t.group == 0) {
      refuse("triangle " + std::to_string(t.tag) + " of surface " + std::to_string(t.entity) +
             " is in no physical surface, but others are; put every surface in one");
    }
    subdomains.emplace(grouped ? t.group : t.entity, 0);
  }
  for (auto& [tag, index] : subdomains) {
    index = static_cast<std::int32_t>(mesh.subdomains.size());
    const auto named = file.surface_names.find(tag);
    const bool has_name = grouped && named != file.surface_names.end() && !named->second.empty();
    mesh.subdomains.push_back(has_name ? printable(named->second) : std::to_string(tag));
  }
  if (std::set(mesh.subdomains.begin(), mesh.subdomains.end()).size() < subdomains.size()) {
    refuse("two physical surfaces have the same name; give each its own");
  }
  if (subdomains.size() < 2) {
    refuse("the mesh has one surface, \"" + mesh.subdomains[0] +
           "\"; an interface must cut the membrane into two surfaces at least, each a physical "
           "surface");
  }
  for (const auto& t : file.triangles) {
    mesh.subdomain.push_back(subdomains.at(grouped ? t.group : t.entity));
  }
  return subdomains;
}

/// Takes the nodes that triangles use, in the order of the file.
NodeIndex take_nodes(const MshFile& file, Mesh& mesh) {
  NodeIndex index;
  for (const std::uint64_t tag : file.node_tags) {
    if (!index.emplace(tag, -1).second) {
      refuse("node " + std::to_string(tag) + " is there twice; save the mesh again");
    }
  }
  for (const auto& t : file.triangles) {
    for (const std::uint64_t tag : t.nodes) {
      const auto found = index.find(tag);
      if (found == index.end()) {
        refuse("triangle " + std::to_string(t.tag) + " has node " + std::to_string(tag) +
               ", which the file does not define");
      }
      found->second = 0;
    }
  }
  double extent = 0;
  for (std::size_t i = 0; i < file.xyz.size(); i += 3) {
    extent = std::max({extent, std::abs(file.xyz[i]), std::abs(file.xyz[i + 1])});
  }
  for (std::size_t i = 0; i < file.node_tags.size(); ++i) {
    std::int32_t& place = index[file.node_tags[i]];
    if (place < 0) continue;
    const double z = file.xyz[3 * i + 2];
    if (std::abs(z) > plane_tolerance * extent) {
      refuse("node " + std::to_string(file.node_tags[i]) + " lies at z = " + std::to_string(z) +
             "; a membrane lies in the plane z = 0");
    }
    place = static_cast<std::int32_t>(mesh.node_count());
    mesh.xy.push_back(file.xyz[3 * i]);
    mesh.xy.push_back(file.xyz[3 * i + 1]);
  }
  const std::size_t unused = file.node_tags.size() - mesh.node_count();
  if (unused > 0) {
    mesh.warnings.push_back(std::to_string(unused) +
                            " nodes that belong to no triangle were left out");
  }
  return index;
}

void take_triangles(const MshFile& file, const NodeIndex& index, Mesh& mesh) {
  std::size_t turned = 0;
  for (const auto& t : file.triangles) {
    for (const std::uint64_t tag : t.nodes) mesh.triangles.push_back(index.at(tag));
    const std::size_t last = mesh.triangle_count() - 1;
    if (mesh::area(mesh, last) < 0) {
      std::swap(mesh.triangles[3 * last + 1], mesh.triangles[3 * last + 2]);
      ++turned;
    }
    if (!(mesh::area(mesh, last) > 0)) {
      refuse("triangle " + std::to_string(t.tag) + " at " +
             place_of(mesh, mesh.triangles[3 * last]) + " has no area; mesh again");
    }
  }
  if (turned > 0) {
    mesh.warnings.push_back(std::to_string(turned) +
                            " triangles were clockwise and have been turned round");
  }
}

std::vector<CurveEdge> take_lines(const MshFile& file, const NodeIndex& index,
                                  const std::map<int, CurveGroup>& groups) {
  std::vector<CurveEdge> lines;
  for (const auto& line : file.lines) {
    const auto a = index.find(line.nodes[0]);
    const auto b = index.find(line.nodes[1]);
    const bool there = a != index.end() && b != index.end() && a->second >= 0 && b->second >= 0;
    if (there) {
      lines.push_back({a->second, b->second, line.group});
    } else if (groups.contains(line.group)) {
      refuse("line " + std::to_string(line.tag) + " of curve \"" + groups.at(line.group).full +
             "\" has a node that belongs to no triangle; mesh surfaces and curves together");
    }
  }
  return lines;
}

/// Nodes of the outer boundary; fills in mesh.dirichlet.
std::set<std::int32_t> take_boundary(const mesh::EdgeTable& edges, const NamedEdges& named,
                                     const std::map<int, CurveGroup>& groups, Mesh& mesh) {
  const bool any = std::any_of(groups.begin(), groups.end(), [](const auto& entry) {
    return entry.second.role == CurveRole::dirichlet;
  });
  std::set<std::int32_t> nodes;
  edges.each([&](std::span<const mesh::EdgeUse> uses) {
    if (uses.size() != 1) return;
    const auto& edge = uses[0];
    nodes.insert(edge.from);
    nodes.insert(edge.to);
    const CurveGroup* group = named.find(edge.from, edge.to);
    const bool held = group == nullptr ? !any : group->role == CurveRole::dirichlet;
    if (held) mesh.dirichlet.push_back({edge.from, edge.to});
  });
  if (mesh.dirichlet.empty()) {
    refuse(
        "no edge of the boundary is dirichlet, so nothing holds the membrane; put some of its "
        "boundary in a physical curve \"dirichlet\"");
  }
  if (!any) {
    mesh.warnings.push_back("no physical curve is named \"dirichlet\"; the boundary" +
                            std::string(groups.empty() ? "" : ", where it has no name,") +
                            " is taken to be");
  }
  return nodes;
}

/// Which way the lines of the file run along chains.
class LineDirections {
 public:
  explicit LineDirections(const std::vector<CurveEdge>& lines) {
    for (const CurveEdge& line : lines) _directed.insert({line.from, line.to});
  }
  /// +1: all along the chain, -1: all against it, 0: neither, or no line there.
  int along(const Chain& chain) const {
    bool forwards = false;
    bool backwards = false;
    for (std::size_t i = 0; i + 1 < chain.nodes.size(); ++i) {
      forwards |= _directed.contains({chain.nodes[i], chain.nodes[i + 1]});
      backwards |= _directed.contains({chain.nodes[i + 1], chain.nodes[i]});
    }
    return static_cast<int>(forwards) - static_cast<int>(backwards);
  }

 private:
  std::set<std::pair<std::int32_t, std::int32_t>> _directed;
};

/// Walks the chain with its plus side on the left, by the rules of the header.
Chain orient(Chain chain, const Mesh& mesh, const LineDirections& directions, bool& guessed) {
  const auto name = [&](std::int32_t s) { return mesh.subdomains[static_cast<std::size_t>(s)]; };
  const auto is_plus = [&](std::int32_t s, std::int32_t facing) {
    return name(s) == "plus" || name(facing) == "minus";
  };
  guessed = false;
  if (is_plus(chain.left, chain.right)) return chain;
  if (is_plus(chain.right, chain.left)) return reversed(std::move(chain));
  const int direction = directions.along(chain);
  if (direction > 0) return chain;
  if (direction < 0) return reversed(std::move(chain));
  guessed = true;
  return chain.left > chain.right ? chain : reversed(std::move(chain));
}

std::int32_t inclusion_index(const std::string& name, Mesh& mesh) {
  const auto found = std::find(mesh.inclusions.begin(), mesh.inclusions.end(), name);
  if (found == mesh.inclusions.end()) mesh.inclusions.push_back(name);
  return static_cast<std::int32_t>(std::distance(
      mesh.inclusions.begin(), std::find(mesh.inclusions.begin(), mesh.inclusions.end(), name)));
}

bool same_body(const CurveGroup& a, const CurveGroup& b) {
  const bool cracks = a.role == CurveRole::crack && b.role == CurveRole::crack;
  const bool inclusions = a.role != CurveRole::crack && b.role != CurveRole::crack;
  return (cracks || inclusions) && a.name == b.name;
}

/// A crack or inclusion must lie strictly inside, and share no tip with another.
void check_tips(const Mesh& mesh, const Chain& chain, const std::vector<const CurveGroup*>& groups,
                const std::set<std::int32_t>& boundary) {
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (groups[i] == nullptr) continue;
    for (const std::size_t k : {i, i + 1}) {
      const bool end = k == 0 || k + 1 == chain.nodes.size();
      if (end || boundary.contains(chain.nodes[k])) {
        refuse("curve \"" + groups[i]->full + "\" reaches " +
               (boundary.contains(chain.nodes[k]) ? "the boundary" : "the end of its interface") +
               " at " + place_of(mesh, chain.nodes[k]) + "; a tip must lie inside the membrane");
      }
    }
    if (i > 0 && groups[i - 1] != nullptr && !same_body(*groups[i - 1], *groups[i])) {
      refuse("curves \"" + groups[i - 1]->full + "\" and \"" + groups[i]->full +
             "\" share the tip " + place_of(mesh, chain.nodes[i]) +
             "; leave an unnamed curve between them");
    }
  }
}

mesh::Interface make_interface(const Chain& chain, const std::vector<const CurveGroup*>& groups,
                               Mesh& mesh) {
  mesh::Interface interface;
  interface.nodes = chain.nodes;
  for (const CurveGroup* group : groups) {
    Kind kind = Kind::glue;
    std::int32_t inclusion = -1;
    if (group != nullptr && group->role == CurveRole::crack) {
      kind = Kind::crack;
    } else if (group != nullptr) {
      kind = group->role == CurveRole::inclusion ? Kind::inclusion : Kind::delaminated;
      inclusion = inclusion_index(group->name, mesh);
    }
    interface.kind.push_back(kind);
    interface.inclusion.push_back(inclusion);
  }
  return interface;
}

void take_interfaces(const mesh::EdgeTable& edges, const NamedEdges& named,
                     const std::vector<CurveEdge>& lines, const std::set<std::int32_t>& boundary,
                     Mesh& mesh) {
  const LineDirections directions(lines);
  std::vector<bool> connected(mesh.subdomains.size(), false);
  std::vector<Chain> chains = build_chains(mesh, edges);
  for (Chain& found : chains) {
    bool guessed = false;
    const Chain chain = orient(std::move(found), mesh, directions, guessed);
    const auto left = static_cast<std::size_t>(chain.left);
    const auto right = static_cast<std::size_t>(chain.right);
    connected[left] = connected[right] = true;
    std::vector<const CurveGroup*> groups;
    for (std::size_t i = 0; i + 1 < chain.nodes.size(); ++i) {
      groups.push_back(named.find(chain.nodes[i], chain.nodes[i + 1]));
    }
    check_tips(mesh, chain, groups, boundary);
    mesh.interfaces.push_back(make_interface(chain, groups, mesh));
    mesh.interfaces.back().name =
        chains.size() == 1 ? "interface" : "interface" + std::to_string(mesh.interfaces.size());
    if (guessed) {
      mesh.warnings.push_back("surface \"" + mesh.subdomains[left] +
                              "\" is taken for the plus side of " + mesh.interfaces.back().name +
                              "; name the surface on that side \"plus\" to choose");
    }
  }
  for (std::size_t s = 0; s < connected.size(); ++s) {
    if (!connected[s]) {
      refuse("surface \"" + mesh.subdomains[s] +
             "\" shares no edge with another; let neighbours share the nodes of their common curve "
             "(in gmsh: one curve for both, or Coherence)");
    }
  }
}

void check_plane(const mesh::EdgeTable& edges, const Mesh& mesh) {
  edges.each([&](std::span<const mesh::EdgeUse> uses) {
    const bool overlap = uses.size() == 2 && uses[0].from == uses[1].from;
    if (uses.size() <= 2 && !overlap) return;
    refuse("triangles overlap at the edge " + place_of(mesh, uses[0].from) + "-" +
           place_of(mesh, uses[0].to) + ", which belongs to " + std::to_string(uses.size()) +
           "; put every surface in one physical group and mesh it once");
  });
}

}  // namespace

Mesh to_mesh(const MshFile& file) {
  if (file.triangles.empty()) {
    refuse(
        "the mesh has no triangle; mesh in two dimensions (gmsh -2) and put the surfaces in "
        "physical groups before saving");
  }
  if (file.node_tags.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    refuse("the mesh has " + std::to_string(file.node_tags.size()) + " nodes, too many to number");
  }
  const std::map<int, CurveGroup> groups = read_curve_groups(file.curve_names);
  Mesh mesh;
  read_subdomains(file, mesh);
  const NodeIndex index = take_nodes(file, mesh);
  take_triangles(file, index, mesh);
  const std::vector<CurveEdge> lines = take_lines(file, index, groups);
  const mesh::EdgeTable edges(mesh.triangles);
  check_plane(edges, mesh);
  const NamedEdges named(mesh, edges, lines, groups);
  const std::set<std::int32_t> boundary = take_boundary(edges, named, groups, mesh);
  take_interfaces(edges, named, lines, boundary, mesh);
  mesh::validate(mesh);
  return mesh;
}

Mesh import_msh(const mesh::ImportRequest& request) {
  require_msh(request.path);
  std::ifstream in(request.path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (in.bad()) refuse("the mesh file cannot be read to its end");
  return to_mesh(read_msh(bytes, request.max_triangles));
}

}  // namespace anticrack::mesher
