// SPDX-License-Identifier: GPL-3.0-or-later
//
// The mesh cut along its interfaces: subdomains with local numbers, and the conditions between the
// nodes on both sides of an interface.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ddm/linear_conditions.hpp"
#include "fem/interface_mass.hpp"
#include "fem/tension.hpp"
#include "fem/triangulation.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::ddm {

/// One subdomain Omega_i, index base 0. Nodes are numbered interior, then interfaces (the trace),
/// then Dirichlet boundary, where a node on both counts as Dirichlet. Nearby interior nodes have
/// nearby numbers; triangles are sorted by their smallest node. A mesh node on interfaces occurs
/// once for each of its *sides* in the subdomain, the fans of triangles into which the interface
/// edges cut its neighbourhood: twice on a slit, once at its tip.
struct Subdomain {
  std::string name;
  fem::Triangulation part;
  fem::Tension tension;
  std::vector<std::int32_t> node;      ///< (n) index into Mesh::xy of each local node
  std::vector<std::int32_t> triangle;  ///< (m) index into the mesh's triangles
  std::size_t interior = 0;
  std::size_t trace = 0;
  std::size_t dirichlet = 0;
  std::vector<std::int32_t> rigid;  ///< (trace) inclusion whose plus side (or tip) it is on, or -1
  std::vector<std::int32_t> unknown;  ///< (trace) its entry of the skeleton's w
  /// One trace node of each connected part without Dirichlet nodes, which could move as a whole.
  std::vector<std::int32_t> floating;

  /// Nodes whose u is unknown.
  std::size_t free() const noexcept { return interior + trace; }
};

/// The two sides of an interface node off the Dirichlet boundary, with one multiplier mu, a force
/// per length that pushes the minus side down and the plus side up. Both sides may lie in one
/// subdomain (slit). The tip of a slit has one side and no pair; a node of a free crack alone has
/// no pair either. Where two edges meet, the stricter condition holds: a tip has u+ = u- (= A_j).
struct NodePair {
  std::int32_t node = 0;   ///< index into Mesh::xy
  std::int32_t minus = 0;  ///< subdomain, and index in its trace
  std::int32_t minus_trace = 0;
  std::int32_t plus = 0;
  std::int32_t plus_trace = 0;
  mesh::Kind kind = mesh::Kind::glue;
  std::int32_t inclusion = -1;
  /// Index into Skeleton::contacts; -1 if tied, or if [u] >= 0 follows from other pairs here.
  std::int32_t contact = -1;

  /// Whether the condition is [u] >= 0; otherwise it is [u] = 0.
  bool unilateral() const noexcept {
    return kind == mesh::Kind::crack || kind == mesh::Kind::delaminated;
  }
};

/// A condition  w[plus] - w[minus] >= 0.
struct Contact {
  std::int32_t plus = 0;
  std::int32_t minus = 0;
};

/// A prescribed combination of a body's motions: u of the body is g_D in a node of the Dirichlet
/// boundary, or a given number.
struct Held {
  std::int32_t inclusion = -1;  ///< the first of the body
  std::int32_t node = -1;       ///< its node on the Dirichlet boundary; -1: u is `value`
  double value = 0;
  /// A subdomain that has the node, and the node's index among the Dirichlet nodes there.
  std::int32_t subdomain = -1, dirichlet = -1;
};

/// The motion of an inclusion in terms of w:  u = A + B.(x - centre)  along the inclusion.
struct RigidMotion {
  mesh::Point centre{};    ///< of its nodes' bounding box
  Terms displacement;      ///< A
  Terms slope_x, slope_y;  ///< B; empty if it does not tilt
};

/// All traces together: sides tied by glue, tips and rigid inclusions share one value of w. The
/// rigid motions come first. With d the jumps of the independent conditions, q the values that are
/// free and p the held values:
///
///   w = Z q - P d + O p,   d >= 0,   sum of `dependent` d >= 0
///
/// If several pairs of a cross point require the same condition, it occurs once.
struct Skeleton {
  std::size_t unknowns = 0;          ///< entries of w
  std::size_t free = 0;              ///< entries of q, in the order of w
  std::vector<Row> rows;             ///< (unknowns) rows of Z, -P and O
  std::vector<Contact> contacts;     ///< conditions; those with a jump d of their own come first
  std::size_t independent = 0;       ///< length of d
  std::vector<Terms> dependent;      ///< jumps of the other contacts, as sums of d
  std::vector<Held> held;            ///< entries of p
  std::vector<Terms> agreements;     ///< sums of p that must be 0, or the problem has no solution
  std::vector<RigidMotion> motions;  ///< (inclusions)
  std::vector<std::int32_t> inclusion;  ///< (unknowns) whose body's motion it is or follows, or -1
};

/// The sides at which the traces of an interface node are read, tied or not.
struct SidePair {
  std::int32_t pair = -1;                     ///< -1: Dirichlet node, tip of a slit, or free crack
  std::int32_t minus = -1, minus_trace = -1;  ///< subdomain and trace index; -1: Dirichlet
  std::int32_t plus = -1, plus_trace = -1;
  mesh::Kind kind = mesh::Kind::glue;  ///< condition in the node; glue or inclusion at a tip
};

struct Decomposition {
  std::vector<Subdomain> subdomains;
  std::vector<NodePair> pairs;
  std::vector<fem::MassEdge> edges;                    ///< interface edges between pairs
  std::vector<std::vector<SidePair>> interface_sides;  ///< per interface and node
  Skeleton skeleton;
};

/// Cuts the mesh; subdomains are numbered on `threads` threads. O(m log k) for k interface edges.
/// Throws errors::Error: mesh_invalid for an interface edge without a triangle on each side, an
/// inclusion without edges, or a part of the membrane without Dirichlet node and interface;
/// invalid_argument for inclusions that share nodes and are fixed at different values; numerical
/// for a part that nothing holds; what fem::tension() throws, at "tension_law".
Decomposition cut(const mesh::Mesh& mesh, int threads = 1);

/// The reason why Algorithm 2 of the paper does not apply, with the cure; empty if it applies. It
/// does not if a subdomain has a part without Dirichlet nodes, if the rigid sides of an inclusion
/// lie in two subdomains, or if an inclusion tilts, is held, or shares nodes with another.
std::string uzawa_obstacle(const Decomposition& decomposition, const mesh::Mesh& mesh);

}  // namespace anticrack::ddm
