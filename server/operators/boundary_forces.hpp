// SPDX-License-Identifier: GPL-3.0-or-later
//
// Forces on the sides and holes of the boundary:  int T du/dn phi_i ds  in its nodes i.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/answer.hpp"
#include "ddm/decomposition.hpp"
#include "ddm/neumann_boundary.hpp"
#include "operators/condense_loads.hpp"

namespace anticrack::operators {

/// Where u is given, the force in a node is the residual  int T grad u.grad phi_i - int f phi_i  of
/// its equation; where T du/dn is given, it is the given one. So with those on inclusions they
/// balance the load as exactly as the equations are solved. A node between two sides where u is
/// given has on each the flux of the triangles on its edges, and the rest of its force as these are
/// long, which is exact for linear u. Keeps a reference to the decomposition.
class BoundaryForces {
 public:
  /// O(m), with 12 bytes for each side of a triangle meanwhile.
  BoundaryForces(const mesh::Mesh& mesh, const ddm::Decomposition& decomposition,
                 const ddm::NeumannBoundary& neumann);

  /// The forces of an answer with fields to this load, which has parts. O(boundary).
  std::vector<contact::BoundaryAnswer> of(const contact::Answer& answer,
                                          const LoadOnTraces& load) const;
  /// Per subdomain, 1 in the Dirichlet nodes of a row and 0 in the others; empty if the row is
  /// free, or has a node together with another row where u is given.
  std::vector<Eigen::VectorXd> isolated(std::size_t row) const;
  std::size_t size() const noexcept { return _rows.size(); }  ///< rows
  std::size_t bytes() const noexcept;                         ///< memory

 private:
  /// A part of a node's force that belongs to a row.
  struct Share {
    std::int32_t node = 0;  ///< of the subdomain
    std::int32_t row = 0;
    double part = 1;
  };
  /// A Dirichlet edge, from a triangle's corner `side` to the next.
  struct HeldEdge {
    std::int32_t triangle = 0, side = 0, row = 0;
  };
  struct Local {
    std::vector<Share> held;              ///< Dirichlet nodes, by node
    std::vector<Share> ends;              ///< both ends of each Neumann edge
    std::vector<std::int32_t> triangles;  ///< with Dirichlet nodes
    std::vector<HeldEdge> edges;
  };

  const ddm::Decomposition& _decomposition;
  std::vector<contact::BoundaryAnswer> _rows;  ///< without forces
  std::vector<Local> _local;                   ///< (subdomains)
};

}  // namespace anticrack::operators
