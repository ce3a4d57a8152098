// SPDX-License-Identifier: GPL-3.0-or-later
//
// The length of cracks in contact, with the ends of contact found between the nodes.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ddm/decomposition.hpp"

namespace anticrack::contact {

/// A length and an estimate of its error, in the length unit of the mesh. The estimate is no bound.
struct Measured {
  double length = 0, error = 0;
};

/// Along an interface between its last node a in contact, with pressure p and nodal length m, and
/// its first open node b, with jump d, contact ends at the part
///
///   x = F / (F + T d),   F = m p,   1/T = sum of 1/T of the sides that are not rigid
///
/// of the edge, less the shift 0.2 ((1 - x) m_a + x m_b). While no node changes, the unknowns are
/// linear in the load and so is x, which is 0 when a is about to open and 1 when b has just closed:
/// the length is a continuous function of the load. The shift is what a lattice of triangles adds
/// to contact zones with p ~ s^1/2 and d ~ s^3/2 (0.18 to 0.23 on those of squares and of
/// equilateral triangles, in periodic contact, which has an exact solution). It is no longer than
/// either zone.
/// At a tied node (a tip) the zone ends in the node: the edge there counts whole, but no further
/// than p^2, linear along the last two nodes, stays above 0, and by x if the zone has one node.
/// Where interfaces meet, pressure and jump of a node are several, and the edge counts half.
/// Estimate of the error, at an end: 0.1 m and half the difference of the ends that p^2 and
/// d^(2/3) give, each linear along its last two nodes; at most the edge. Immutable.
class ContactLength {
 public:
  /// O(n), and O(m) in subdomains whose tension varies.
  ContactLength(const ddm::Decomposition& decomposition, const Eigen::VectorXd& lumped_mass);

  /// A node of an interface. Those of interface after interface, in order, ends included.
  struct Node {
    std::int32_t pair = -1;  ///< index into Decomposition::pairs; -1: none
    std::int32_t inclusion = -1;
    bool may_open = false;
    bool meeting = false;  ///< several pairs in one node
    double mass = 0;       ///< its nodal length
    double compliance = 0;
  };
  const std::vector<Node>& nodes() const noexcept { return _nodes; }

  struct Value {
    double pressure = 0, jump = 0;  ///< of both, one is 0
    bool pressed = false;
  };
  /// `values`: one per node; those of nodes that may not open do not count. Adds to `of_inclusion`,
  /// unless it is empty, what belongs to each inclusion. O(n), no allocation.
  Measured measure(std::span<const Value> values, std::span<double> of_inclusion = {}) const;

  std::size_t bytes() const noexcept;

 private:
  struct Edge {
    std::array<std::int32_t, 2> node;
    std::array<std::int32_t, 2> next;  ///< the edge beyond each end, or -1
    double length;
  };
  using Values = std::span<const Value>;
  const Node& node(std::int32_t i) const noexcept { return _nodes[static_cast<std::size_t>(i)]; }
  std::int32_t beyond(const Edge& edge, int end) const noexcept;
  bool known(std::int32_t i, Values values, bool pressed) const noexcept;
  double part(const Edge& edge, int pressed_end, Values values) const noexcept;
  double at_tip(const Edge& edge, int end, Values values) const noexcept;
  double in_contact(const Edge& edge, Values values) const noexcept;
  double room(const Edge& edge, int end, bool contact, double most, Values values) const noexcept;
  double reach(const Edge& edge, int end, bool contact, Values values) const noexcept;
  Measured end_in(const Edge& edge, int pressed_end, Values values) const noexcept;
  Measured measure(const Edge& edge, Values values) const noexcept;

  std::vector<Node> _nodes;
  std::vector<Edge> _edges;  // those of cracks and of delaminated parts
};

}  // namespace anticrack::contact
