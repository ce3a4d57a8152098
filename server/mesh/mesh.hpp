// SPDX-License-Identifier: GPL-3.0-or-later
//
// The mesh of a membrane cut by interfaces, and the conditions that hold on them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fields/fields.hpp"
#include "mesh/bend.hpp"
#include "mesh/tension.hpp"

namespace anticrack::mesh {

/// Condition on an edge of an interface; u+ is the trace on its plus side, [u] = u+ - u-.
/// The numbers are those of the API's InterfaceKind.
enum class Kind : std::int32_t {
  glue = 1,         ///< u+ = u-                                   (gamma_g)
  crack = 2,        ///< [u] >= 0
  inclusion = 3,    ///< u+ = u- = A_j, bonded rigid inclusion j
  delaminated = 4,  ///< u+ = A_j, [u] >= 0                        (gamma_c, paper (3)-(6))
  free = 5,         ///< T du/dn = 0 on both faces, [u] of either sign: a crack without contact
};

/// How an inclusion moves. By default it keeps its direction: u = A along its line, as in the
/// paper.
struct Motion {
  /// If true, a straight inclusion has u = A + B s, s the arc length from its middle (negative at
  /// its first node); any other has u = A + Bx (x - x0) + By (y - y0), (x0, y0) the middle of its
  /// bounding box. These are the rigid motions of a thin plate.
  bool tilt = false;
  std::optional<double> fixed;  ///< held at this u; excludes `tilt`
  bool operator==(const Motion&) const = default;
};
ANTICRACK_FIELDS(Motion, tilt, fixed)

/// A chain of k nodes and k-1 edges, its plus side (the paper's Omega_2) on the left. A closed
/// chain repeats its first node as its last.
struct Interface {
  std::string name;
  std::vector<std::int32_t> nodes;      ///< (k) indices into Mesh::xy
  std::vector<Kind> kind;               ///< (k-1) per edge
  std::vector<std::int32_t> inclusion;  ///< (k-1) index into Mesh::inclusions, -1 for none
};
ANTICRACK_FIELDS(Interface, name, nodes, kind, inclusion)

/// A side or hole of the boundary, or a run of a named group, by its nodes: the edges from `first`
/// to `last`, with the membrane on their left. first == last: all of a closed curve. Bisection
/// keeps these nodes.
struct BoundaryPart {
  std::string name;
  std::int32_t first = 0, last = 0;
};
ANTICRACK_FIELDS(BoundaryPart, name, first, last)

/// Conforming triangulation, index base 0. Interface nodes are stored once; ddm::cut doubles u
/// there. Invariants (`validate`): indices in range; triangles counterclockwise with positive area,
/// not overlapping at an edge; every node and subdomain has a triangle; an interface edge is an
/// edge of exactly two triangles, of different subdomains if it is glue; an edge between two
/// subdomains lies on exactly one interface; a Dirichlet edge belongs to exactly one triangle; an
/// edge has an inclusion if and only if its kind needs one; tension is positive; no motion and no
/// law has a fault. Edges of one triangle that are not in `dirichlet` are the Neumann boundary.
struct Mesh {
  std::vector<double> xy;                ///< (n,2) row-major, unit of the geometry
  std::vector<std::int32_t> triangles;   ///< (m,3) row-major
  std::vector<std::int32_t> subdomain;   ///< (m) index into subdomains
  std::vector<std::string> subdomains;   ///< names
  std::vector<double> tension;           ///< (subdomains) T > 0 of each; empty: 1 everywhere
  std::vector<TensionLaw> tension_laws;  ///< (subdomains) in place of `tension`; empty: no laws
  std::vector<std::string> inclusions;   ///< names
  std::vector<Motion> motions;           ///< (inclusions) of each; empty: all keep their direction
  std::vector<Interface> interfaces;
  std::vector<std::array<std::int32_t, 2>> dirichlet;  ///< edges of the boundary where u = g_D
  std::vector<std::string> warnings;                   ///< what was repaired or assumed
  std::vector<Bend> bends;                             ///< what is left of the curves of a geometry
  std::vector<BentEdge> bent;     ///< for the mesher: edges beside these, see refine_uniform
  std::vector<ChordEdge> chords;  ///< edges on chords of curves
  std::vector<BoundaryPart> boundary_parts;  ///< what has none is called "boundary"
  /// Lower bound, in degrees, of the angles of any bisection of the unrefined mesh. 0: not refined.
  double bisection_bound = 0;

  /// The numbers n of nodes and m of triangles.
  std::size_t node_count() const noexcept { return xy.size() / 2; }
  std::size_t triangle_count() const noexcept { return triangles.size() / 3; }
};
ANTICRACK_FIELDS(Mesh, xy, triangles, subdomain, subdomains, tension, tension_laws, inclusions,
                 motions, interfaces, dirichlet, warnings, bends, bent, chords, boundary_parts,
                 bisection_bound)

/// Throws errors::Error (mesh_invalid) naming the first invariant violated and where. O(m log m).
void validate(const Mesh& mesh);

/// The fault of a motion, with the cure; empty if there is none.
std::string fault_of(const Motion& motion);

/// Signed area of a triangle, length unit squared; positive when counterclockwise.
double area(const Mesh& mesh, std::size_t triangle) noexcept;

inline Point position(const Mesh& mesh, std::int32_t node) noexcept {
  const auto i = 2 * static_cast<std::size_t>(node);
  return {mesh.xy[i], mesh.xy[i + 1]};
}

/// Position of corner 0, 1 or 2 of a triangle.
inline Point corner(const Mesh& mesh, std::size_t triangle, std::size_t i) noexcept {
  return position(mesh, mesh.triangles[3 * triangle + i]);
}

/// A mesh without nodes, triangles and lines that has the subdomains, inclusions and warnings of
/// another.
Mesh without_triangles(const Mesh& mesh);

/// Arc length of each node of an interface from its first node, shape (k).
std::vector<double> arc_length(const Mesh& mesh, const Interface& interface);

}  // namespace anticrack::mesh
