// SPDX-License-Identifier: GPL-3.0-or-later
//
// The steps from a .msh file to a mesh, in their order.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "mesh/edges.hpp"
#include "mesh/geometry.hpp"
#include "mesh/mesh.hpp"
#include "mesher/msh_file.hpp"

namespace anticrack::mesher {

// Nodes and triangles of a file, checked and repaired; groups come later.

struct PlaneMesh {
  std::vector<double> xy;                              ///< (n,2), nodes of triangles only
  std::vector<std::uint64_t> tags;                     ///< (n) numbers in the file
  std::vector<std::int32_t> triangles;                 ///< (m,3), counterclockwise, as in the file
  std::unordered_map<std::uint64_t, std::int32_t> of;  ///< node of each number, -1: in no triangle
  std::vector<std::string> warnings;
};

/// Drops nodes that no triangle uses, turns clockwise triangles round and drops a constant z (to
/// 1e-9 of the extent), with warnings. Throws errors::Error (mesh_invalid): no triangle, too many
/// nodes, a node defined twice or not at all, too large coordinates, varying z, a triangle without
/// area. O(n + m).
PlaneMesh read_plane(const MshFile& file);

// Groups of curves and their meanings, from the file or from the request.

enum class CurveRole { neumann, dirichlet, glue, crack, free, inclusion, delaminated };

/// Whether the role is that of an inclusion or of a part of one.
constexpr bool is_rigid(CurveRole role) noexcept {
  return role == CurveRole::inclusion || role == CurveRole::delaminated;
}

/// Whether the role is that of a part of the boundary.
constexpr bool of_boundary(CurveRole role) noexcept {
  return role == CurveRole::dirichlet || role == CurveRole::neumann;
}

struct CurveMeaning {
  CurveRole role = CurveRole::glue;
  std::string name;  ///< of the inclusion, crack or part of the boundary, or empty
};

/// A text read as a keyword. If there is neither a meaning nor a fault, the text is no keyword.
struct ReadMeaning {
  std::optional<CurveMeaning> meaning;
  std::string fault;  ///< not empty: what is wrong with the NAME of a keyword
};
/// Reads dirichlet, dirichlet:NAME, neumann, neumann:NAME, glue, crack, crack:NAME, free,
/// free:NAME, inclusion:NAME or delaminated:NAME, in upper or lower case, with or without blanks
/// around the words.
ReadMeaning read_meaning(const std::string& text);

struct CurveGroup {
  std::int32_t tag = 0;
  std::string title;                    ///< for messages: curve group 7 "gamma_c"
  std::optional<CurveMeaning> meaning;  ///< none: the surroundings decide
  std::string part;      ///< the file's name, on the boundary; "group-7" where that is no name;
                         ///< empty: a keyword, or no physical group
  bool renamed = false;  ///< `part` is another name than the file's
};

struct CurveGroups {
  /// False if no line is in a physical group; the groups are then the elementary curves.
  bool physical = true;
  std::map<std::int32_t, CurveGroup> groups;

  /// The group of a line, or null.
  const CurveGroup* of(const MshElement<2>& line) const;
};

/// Reads the groups. `given` (physical tag -> meaning) overrides the names of the file. Throws
/// errors::Error: invalid_argument at "options.curve_groups[TAG]" for a tag that the file lacks or
/// a text that is not a keyword; mesh_invalid for a bad NAME, one shared by a crack and an
/// inclusion, or names of groups that no line is in.
CurveGroups read_curve_groups(const MshFile& file,
                              const std::map<std::int32_t, std::string>& given);

// Unites doubled nodes of a file: along cracks made by gmsh's plugin Crack, or along the common
// line of surfaces that were meshed separately. A mesh::Mesh has each node once.

/// Two edges of the file at the same place: after welding one edge with a triangle on each side.
struct DoubledEdge {
  std::int32_t low = 0;   ///< welded nodes, low < high
  std::int32_t high = 0;  ///< welded node
  /// The two sides are not connected over common nodes of the file: they were meshed separately.
  /// The sides of a crack are connected at its tips.
  bool apart = false;
};

struct Welding {
  std::vector<std::int32_t> node;    ///< (n) new number of each node, in order of first occurrence
  std::size_t node_count = 0;        ///< after welding
  std::vector<DoubledEdge> doubled;  ///< by (low, high)

  /// Null if the edge is not doubled. O(log).
  const DoubledEdge* find(std::int32_t a, std::int32_t b) const noexcept;
};

/// Unites nodes of the rim (edges of one triangle) within 1e-9 of the mesh's extent (or as far as
/// their coordinates are rounded) and a
/// thousandth of their shortest rim edge. `xy` (n,2), `triangles` (m,3) counterclockwise, both
/// row-major; `tags` (n) for messages. Throws errors::Error (mesh_invalid): hanging nodes, nodes at
/// the same place without a common edge, overlapping triangles. O(m log m).
Welding weld(std::span<const double> xy, std::span<const std::int32_t> triangles,
             std::span<const std::uint64_t> tags);

// Makes subdomains from the surfaces of the file.

/// Fills mesh.subdomain, mesh.subdomains and mesh.tension, with assumptions in mesh.warnings. Every
/// physical surface is a subdomain, in the order of tags; its name comes from
/// options.surface_groups, else from the file, else it is the tag. Without physical surfaces the
/// elementary ones count; a single one without a name in the options is divided into pieces by
/// `cuts`, the sorted pairs (low, high) of edges on lines of the file or doubled. Throws
/// errors::Error: mesh_invalid; invalid_argument at "options.surface_groups[TAG]" or
/// "options.tension[NAME]". O(m log m).
void read_surfaces(const MshFile& file, const mesh::MeshOptions& options,
                   const mesh::EdgeTable& edges,
                   std::span<const std::pair<std::int32_t, std::int32_t>> cuts, mesh::Mesh& mesh);

// Decides the role of every edge of the mesh, from its groups or from its surroundings.

/// A line of the file with node numbers of the mesh.
struct CurveEdge {
  std::int32_t from = 0;
  std::int32_t to = 0;
  const CurveGroup* group = nullptr;  ///< null: no group
};

/// Walked from -> to, with subdomain `left` on its left; left == right inside a subdomain.
struct InterfaceEdge {
  std::int32_t from = 0;
  std::int32_t to = 0;
  std::int32_t left = 0;
  std::int32_t right = 0;
  CurveMeaning meaning;  ///< neither dirichlet nor neumann
};

/// An edge of the boundary, the membrane on its left.
struct BoundaryEdge {
  std::int32_t from = 0;
  std::int32_t to = 0;
  std::string part;  ///< a name; edges without one are left out
};

struct EdgeRoles {
  std::vector<std::array<std::int32_t, 2>> dirichlet;
  std::vector<BoundaryEdge> named;        ///< by (low, high)
  std::vector<InterfaceEdge> interfaces;  ///< by (low, high)
};

/// Groups with a meaning decide. Several groups must agree: names that are not keywords do not
/// count, inclusion:NAME with delaminated:NAME gives delaminated:NAME, any two cracks agree, as do
/// any two free ones; of the boundary one with a NAME and one without.
/// Without a meaning the surroundings decide:
///   - on the boundary: dirichlet if the edge is in a group or no boundary edge is; else neumann;
///   - on doubled nodes: crack, unless both sides were meshed separately;
///   - between two subdomains: glue;
///   - inside a subdomain: nothing, as for glue.
/// mesh.warnings lists these decisions, except glue of edges in no group if the file gives any
/// curve a meaning. An edge of the boundary has the NAME of its meaning, else the name of its
/// group, of several the first by tag, which is warned of. `mesh` has its nodes, triangles and
/// subdomains. Throws errors::Error (mesh_invalid): an edge with two meanings or one that does not
/// fit its place, a line with a meaning that is not an edge, no dirichlet edge. O(m log m).
EdgeRoles read_edges(const mesh::EdgeTable& edges, std::span<const CurveEdge> lines,
                     const CurveGroups& groups, const Welding& welding, mesh::Mesh& mesh);

/// The named edges of the boundary as parts, of which several may have one name. Without a name,
/// with a warning, remain parts that begin where the boundary touches itself, and all if they have
/// more than a thousand names. O(e log e) for e edges.
std::vector<mesh::BoundaryPart> boundary_parts(std::span<const BoundaryEdge> named,
                                               const mesh::EdgeTable& edges, mesh::Mesh& mesh);

// Joins the edges of interfaces to chains and finds their plus sides.

/// A chain of nodes with subdomain `left` on its left and `right` on its right; both are equal for
/// a slit.
struct Chain {
  std::int32_t left = 0;
  std::int32_t right = 0;
  std::vector<std::int32_t> nodes;          ///< k; a closed chain repeats its first node
  std::vector<const InterfaceEdge*> edges;  ///< k-1

  /// Whether the chain is a ring.
  bool closed() const noexcept { return nodes.front() == nodes.back(); }
};

/// Joins edges to chains. Chains end at free ends, at the boundary and at cross points (nodes that
/// do not have exactly two edges). An open chain starts at its lower end node, a ring at its lowest
/// node. Sorted by (lower, higher) subdomain, then by node. `on_boundary` (n). O(e log e) for e
/// edges.
std::vector<Chain> build_chains(std::span<const InterfaceEdge> edges,
                                const std::vector<bool>& on_boundary);

/// The lines of a file: first node, second node.
using DirectedLines = std::set<std::pair<std::int32_t, std::int32_t>>;

struct Oriented {
  Chain chain;       ///< plus side on its left
  std::string note;  ///< a warning that rule 3 applied, or empty
};

/// Turns the chain so that its plus side is on the left. The plus side is, by the first rule that
/// applies:
///   1. between two subdomains: the one called `plus`, or the one that faces `minus`;
///   2. the side left of the lines on its cracks and inclusions (else of all lines), if they agree;
///   3. between two subdomains: the one with the higher number; inside one: the left of the chain
///      from its end with the lower x (then y), or the inside of a ring.
/// Rule 3 gives no note for a chain of glue only: no answer depends on it.
Oriented orient(Chain chain, const mesh::Mesh& mesh, const DirectedLines& lines);

// Warnings about edges whose meaning the import assumed.

enum class Assumed {
  dirichlet,
  neumann,   ///< on the boundary, in no group
  glue,      ///< between two subdomains
  welded,    ///< glue between subdomains that were meshed separately
  joined,    ///< no interface, between separately meshed parts of a subdomain
  crack,     ///< doubled nodes
  nothing,   ///< a line inside one subdomain
  left_out,  ///< no edge of a triangle
};

class Assumptions {
 public:
  /// Adds an edge in a group without meaning.
  void add(const CurveGroup& group, Assumed assumed);
  /// Adds an edge in no group. `node`: one of its nodes.
  void add(Assumed assumed, std::int32_t node);

  /// Adds the warnings to mesh.warnings: one per group and meaning; for edges without a group, and
  /// for curves of a file without groups, one per meaning.
  void tell(const CurveGroups& groups, mesh::Mesh& mesh) const;

 private:
  struct Bare {
    std::size_t edges = 0;
    std::int32_t node = 0;  ///< a node of the first edge
  };

  std::map<std::pair<std::int32_t, Assumed>, std::size_t> _by_group;
  std::map<Assumed, Bare> _bare;
};

}  // namespace anticrack::mesher
