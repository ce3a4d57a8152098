// SPDX-License-Identifier: GPL-3.0-or-later
//
// Refinement of a mesh, graded towards the tips, by newest-vertex bisection.
//
// At an open delaminated tip one face of the crack is Dirichlet, the other Neumann, and
// u ~ r^{1/4}; elements of size h0 r^{1-m} with m < 1/4 restore the rates of smooth solutions.
//
// Every mesh returned satisfies `validate` if the base does, and:
//   - nodes of the base keep their numbers, new ones follow;
//   - a new node is the midpoint 0.5 (a + b) of an edge, so dyadic coordinates stay exact;
//   - triangles inherit the subdomain; pieces of interface and Dirichlet edges the kind, inclusion,
//     direction and place in the chain; names, tension and warnings are copied;
//   - equal input gives equal bits.
//
// R. Stevenson, The completion of locally refined simplicial partitions created by bisection, Math.
// Comp. 77 (2008); M. Karkulik, D. Pavlicek, D. Praetorius, On 2D newest vertex bisection, Constr.
// Approx. 38 (2013), for initial labels that are not compatible.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/edge_ends.hpp"
#include "mesh/edges.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::mesh {

/// A triangle T with longest edge h_T at distance r_t from a tip t is bisected until, for every
/// tip,
///
///   h_T <= min(h0, max(h_tip, h0 (r_t/R_t)^{1-m})).
///
/// R_t is how far the grading of a tip reaches. With up to 16 tips it reaches over the membrane:
/// R_t = R = characteristic_length(mesh). With more tips each has a share, R_t = R sqrt(16/tips),
/// or, if longer, the length of the crack or of the part of an inclusion that ends there, at most
/// R. So n short fibres at distances d are graded up to about 1.4 d from their tips, whatever n,
/// and their gradings do not pile up. At distances far below R_t the rule is the same for cracks of
/// any length: a small one is resolved as well as a large one. Lengths are in the unit of the mesh;
/// R makes the rule independent of it.
///
/// Closer to a tip than R_t (h0/R_t)^{1/m} the required size is below the distance itself, so only
/// triangles at the tip are still cut, about a dozen per halving of h_tip. Stopping at h_tip causes
/// an error of order (h_tip/R_t)^{1/2} in A; with h_tip = R (h0/R)^{1/m} the error of Example 3 at
/// 20,000 triangles doubles. So with up to 16 tips the default is the smallest size. With more,
/// whose halvings would be most of the mesh, it is R_t (h0/R_t)^{1/m} / 1000: the error at tips is
/// then 30 times smaller, and of higher order in h0 than the errors away from tips.
struct Grading {
  double h0 = 0;              ///< longest edge allowed at a distance of R_t and more, > 0
  double m = 0.2;             ///< 0 < m < 1, below the solution's exponent at a tip; 1: uniform
  double tip_size = 0;        ///< h_tip; 0: see above
  double least_tip_size = 0;  ///< h_tip is at least this, and `smallest_tip_size`
};

/// Half the side of a square of the mesh's area: 1 for (-1,1) x (-1,1).
double characteristic_length(const Mesh& mesh);

/// The share of a length R that each of `tip_count` tips has: R sqrt(16/tips), at most R.
double tip_share(double length, std::size_t tip_count) noexcept;

/// 1e-13 max(R, largest |coordinate| of a node of `centres`): at least 450 ulp there, so rounding
/// of midpoints changes angles by about a hundredth at most.
double smallest_tip_size(const Mesh& mesh, std::span<const std::int32_t> centres);

/// Nodes, ascending, where the condition on an interface changes and the solution is singular:
///   - two interface edges that differ in kind or inclusion meet there;
///   - a single interface edge other than glue ends there, inside the domain or, if the edge itself
///     lies on the boundary, on it. A crack that leaves through the boundary has no tip there.
/// Glue between subdomains of one tension does not count: an inclusion may cross an outline.
/// Corners of an interface or of the boundary are no tips. O(m log m).
std::vector<std::int32_t> tips(const Mesh& mesh);
/// The same from the edges of the mesh's triangles and edge_ends(mesh, edges). O(m).
std::vector<std::int32_t> tips(const Mesh& mesh, const EdgeTable& edges,
                               std::span<const EdgeEnd> ends);

/// Grades the mesh towards tips(base); if there are no tips, every edge becomes at most h0.
/// Triangles that are fine enough stay. Throws errors::Error: invalid_argument at "h0", "m" or
/// "tip_size"; limit_exceeded at "h0" beyond `max_triangles`; mesh_invalid for an edge of three
/// triangles. O(n log n) for n triangles of the result; 60 bytes a triangle besides the result.
Mesh grade(const Mesh& base, const Grading& grading, std::size_t max_triangles);

/// Grades the mesh towards given nodes of the base.
Mesh grade(const Mesh& base, std::span<const std::int32_t> centres, const Grading& grading,
           std::size_t max_triangles);

/// Bisects triangle t of the base until its parts have at most 2^-levels[t] of its area, and others
/// where the mesh must conform; levels (m). Parts with an area below (1e-13 |coordinate|)^2 / 2
/// stay, since rounding of midpoints would spoil their shape. Sets `bisection_bound`. Throws
/// errors::Error: limit_exceeded beyond `max_triangles`; mesh_invalid as grade() does. Costs as
/// grade().
Mesh refine(const Mesh& base, std::span<const std::uint8_t> levels, std::size_t max_triangles);

/// Lower bound, degrees, of all angles that bisection can make of this base: four classes of
/// similar triangles from each triangle. O(m log m).
double bisection_bound(const Mesh& base);

}  // namespace anticrack::mesh
