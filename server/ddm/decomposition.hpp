// SPDX-License-Identifier: GPL-3.0-or-later
//
// The mesh cut along its interfaces: subdomains with numbers of their own, and which nodes face
// each other across an interface under which condition.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fem/interface_mass.hpp"
#include "fem/triangulation.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::ddm {

/// One subdomain Omega_i. Its nodes are numbered interior first, then those on interfaces (the
/// trace), then those on the Dirichlet boundary; index base 0. A node that is on an interface and
/// on the Dirichlet boundary counts as Dirichlet.
struct Subdomain {
  std::string name;
  fem::Triangulation part;
  std::vector<std::int32_t> node;  ///< (n) index into Mesh::xy of each local node
  std::size_t interior = 0;
  std::size_t trace = 0;
  std::size_t dirichlet = 0;
  std::vector<std::int32_t> rigid;  ///< (trace) inclusion whose plus side holds the node, or -1

  std::size_t free() const noexcept { return interior + trace; }
};

/// The two sides of an interface node that is not on the Dirichlet boundary; carries one multiplier
/// mu, a force per length that pushes the minus side down and the plus side up.
/// In the node of two edges the stricter condition holds: a tip is tied, u+ = u- (= A_j).
struct NodePair {
  std::int32_t node = 0;   ///< index into Mesh::xy
  std::int32_t minus = 0;  ///< subdomain, and number in its trace
  std::int32_t minus_trace = 0;
  std::int32_t plus = 0;
  std::int32_t plus_trace = 0;
  mesh::Kind kind = mesh::Kind::glue;
  std::int32_t inclusion = -1;

  /// [u] >= 0 here; elsewhere [u] = 0.
  bool unilateral() const noexcept {
    return kind == mesh::Kind::crack || kind == mesh::Kind::delaminated;
  }
};

struct Decomposition {
  std::vector<Subdomain> subdomains;
  std::vector<NodePair> pairs;
  std::vector<fem::MassEdge> edges;  ///< interface edges between pairs
  std::vector<std::vector<std::int32_t>>
      interface_pairs;                            ///< per interface and node; -1: Dirichlet
  std::vector<std::int32_t> inclusion_subdomain;  ///< per inclusion: where its plus side lies
};

/// Throws errors::Error where this version has no method, with the cure: numerical for a part of a
/// subdomain without Dirichlet nodes; not_implemented for a crack or inclusion that touches the
/// Dirichlet boundary, or ends where more than two subdomains meet, for an inclusion whose plus
/// side lies in two subdomains, for two inclusions that share a node; mesh_invalid for an interface
/// edge without a triangle on each side and for an inclusion without edges. Nodes in which more
/// than two subdomains meet (glue only) get a pair per couple of neighbours. O(m log k), k the
/// number of interface edges.
Decomposition cut(const mesh::Mesh& mesh);

}  // namespace anticrack::ddm
