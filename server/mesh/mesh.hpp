// SPDX-License-Identifier: GPL-3.0-or-later
//
// The mesh of a membrane cut by interfaces, and the conditions that hold on them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "fields/fields.hpp"

namespace anticrack::mesh {

/// Condition on an edge of an interface; u+ is the trace on its plus side, [u] = u+ - u-.
/// The numbers are those of the API's InterfaceKind.
enum class Kind : std::int32_t {
  glue = 1,         ///< u+ = u-                                   (gamma_g)
  crack = 2,        ///< [u] >= 0
  inclusion = 3,    ///< u+ = u- = A_j, bonded rigid inclusion j
  delaminated = 4,  ///< u+ = A_j, [u] >= 0                        (gamma_c, paper (3)-(6))
};

/// A chain of k nodes and k-1 edges. Its plus side (the paper's Omega_2) is on the left, walked in
/// the order given. A closed chain has its first node again as its last.
struct Interface {
  std::string name;
  std::vector<std::int32_t> nodes;      ///< (k) indices into Mesh::xy
  std::vector<Kind> kind;               ///< (k-1) per edge
  std::vector<std::int32_t> inclusion;  ///< (k-1) index into Mesh::inclusions, -1 for none
};
ANTICRACK_FIELDS(Interface, name, nodes, kind, inclusion)

/// Conforming triangulation, index base 0. Nodes on an interface are stored once: the doubling of
/// u across it is made by ddm::cut.
/// Invariants (checked by `validate`): indices in range, triangles counterclockwise with positive
/// area, every subdomain has a triangle, every interface edge is an edge of exactly two triangles,
/// of different subdomains where it is glue (a slit has one subdomain on both sides), every edge
/// between two subdomains lies on exactly one interface, every Dirichlet edge belongs to exactly
/// one triangle; every node belongs to a triangle, triangles do not overlap at an edge, an edge has
/// an inclusion just if its kind needs one, tension is positive.
/// Edges of one triangle that are not in `dirichlet` are the Neumann boundary.
struct Mesh {
  std::vector<double> xy;               ///< (n,2) row-major, unit of the geometry
  std::vector<std::int32_t> triangles;  ///< (m,3) row-major
  std::vector<std::int32_t> subdomain;  ///< (m) index into subdomains
  std::vector<std::string> subdomains;  ///< names
  std::vector<double> tension;          ///< (subdomains) T > 0 of each; empty: 1 everywhere
  std::vector<std::string> inclusions;  ///< names
  std::vector<Interface> interfaces;
  std::vector<std::array<std::int32_t, 2>> dirichlet;  ///< edges of the boundary where u = g_D
  std::vector<std::string> warnings;                   ///< what an import repaired or assumed
  /// Degrees: no bisection of the mesh this one was refined from has a smaller angle. 0: not
  /// refined
  double bisection_bound = 0;

  /// n and m of the shapes above.
  std::size_t node_count() const noexcept { return xy.size() / 2; }
  std::size_t triangle_count() const noexcept { return triangles.size() / 3; }
};
ANTICRACK_FIELDS(Mesh, xy, triangles, subdomain, subdomains, tension, inclusions, interfaces,
                 dirichlet, warnings, bisection_bound)

/// Throws errors::Error (mesh_invalid) naming the first invariant that does not hold and where.
/// O(m log m).
void validate(const Mesh& mesh);

/// Signed area of a triangle, length unit squared; positive when counterclockwise.
double area(const Mesh& mesh, std::size_t triangle) noexcept;

/// Smallest angle over all triangles, degrees. O(m).
double minimum_angle(const Mesh& mesh) noexcept;

/// Arc length of each node of an interface from its first node, shape (k).
std::vector<double> arc_length(const Mesh& mesh, const Interface& interface);

}  // namespace anticrack::mesh
