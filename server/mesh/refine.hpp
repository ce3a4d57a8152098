// SPDX-License-Identifier: GPL-3.0-or-later
//
// Refinement of a mesh: graded towards the tips by newest-vertex bisection, or everywhere by four.
//
// At an open delaminated tip one face of the crack is Dirichlet, the other Neumann, and
// u ~ r^{1/4}; elements of size h0 r^{1-m} with m < 1/4 restore the rates of smooth solutions.
//
// What holds of every mesh returned, if the base satisfies `validate`:
//   - it satisfies `validate`; nodes of the base come first and keep their numbers, new ones
//   follow;
//   - a new node is the midpoint 0.5 (a + b) of an edge, so dyadic coordinates stay exact;
//   - triangles inherit the subdomain, pieces of interface and dirichlet edges their edge's kind,
//     inclusion, direction and place in the chain; names, tension and warnings are copied;
//   - equal input gives equal bits.
//
// Source: R. Stevenson, The completion of locally refined simplicial partitions created by
// bisection, Math. Comp. 77 (2008); M. Karkulik, D. Pavlicek, D. Praetorius, On 2D newest vertex
// bisection, Constr. Approx. 38 (2013), for initial labels that are not compatible.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"

namespace anticrack::mesh {

/// A triangle T with longest edge h_T at distance r from the nearest tip is bisected until
///
///   h_T <= min(h0, max(h_tip, h0 (r/R)^{1-m})),   R = characteristic_length(mesh).
///
/// R makes the answer independent of the unit of length. Lengths in the unit of the mesh.
///
/// Closer to a tip than R (h0/R)^{1/m} the rule asks for less than the distance itself; only
/// triangles that touch the tip are cut from there on, about a dozen for each halving of h_tip.
/// What is left uncut costs an error of the order (h_tip/R)^{1/2} in A: with h_tip = R (h0/R)^{1/m}
/// that doubles the error of Example 3 at 20,000 triangles, so 0 goes all the way down.
struct Grading {
  double h0 = 0;        ///< longest edge allowed at a distance of R and more, > 0
  double m = 0.2;       ///< 0 < m < 1 below the exponent of the solution at a tip; 1: uniform
  double tip_size = 0;  ///< h_tip; 0: `smallest_tip_size`
};

/// Half the side of the square of the mesh's area: 1 for the square (-1,1) x (-1,1). Does not
/// change when the membrane is moved or turned.
double characteristic_length(const Mesh& mesh);

/// 1e-13 max(R, largest coordinate of a node of `centres` in absolute value): at least 450 units in
/// the last place of a coordinate there, so rounding of midpoints leaves the angles right to about
/// a hundredth.
double smallest_tip_size(const Mesh& mesh, std::span<const std::int32_t> centres);

/// Nodes where the solution is singular because the condition on an interface changes, ascending:
///   - two interface edges meet there, of one interface or of several, that differ in kind or in
///     inclusion (glue | crack, bonded | delaminated, inclusion 0 | inclusion 1, ...);
///   - one single interface edge other than glue ends there, and the end is free: inside the
///     domain, or the edge itself lies on the boundary. A crack that leaves through the boundary
///     has no tip there.
/// Corners of an interface or of the boundary are not tips. O(m log m).
std::vector<std::int32_t> tips(const Mesh& mesh);

/// Grades towards tips(base). Without a tip every edge is at most h0. Triangles of the base that
/// are fine enough stay as they are; grade a base once and not its graded mesh again, whose longest
/// edges are not those the bisection would go on with.
/// Throws errors::Error: invalid_argument at "h0", "m" or "tip_size"; limit_exceeded at "h0" when
/// the result would have more than `max_triangles`; mesh_invalid for an edge of three triangles.
/// O(n log n) in the triangles of the result, memory about 60 bytes a triangle besides the result.
Mesh grade(const Mesh& base, const Grading& grading, std::size_t max_triangles);

/// The same towards given nodes of the base instead of its tips.
Mesh grade(const Mesh& base, std::span<const std::int32_t> centres, const Grading& grading,
           std::size_t max_triangles);

/// Cuts every triangle into four similar to it: the angles stay, h halves everywhere.
/// Throws errors::Error (limit_exceeded) if the result's indices do not fit. O(m log m).
Mesh refine_uniform(const Mesh& base);

/// The smallest angle, degrees, that `grade` can ever make of this base: bisection produces four
/// classes of similar triangles from each triangle and its longest edge. O(m log m).
double bisection_bound(const Mesh& base);

}  // namespace anticrack::mesh
