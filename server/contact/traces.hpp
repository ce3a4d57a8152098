// SPDX-License-Identifier: GPL-3.0-or-later
//
// u and its contacts along interfaces and on subdomains, as plain arrays.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/mesh.hpp"

namespace anticrack::contact {

/// Traces along one interface, one value per node of mesh::Interface::nodes, ends included.
struct Trace {
  std::vector<double> u_minus;
  std::vector<double> u_plus;
  std::vector<double> jump;      ///< u_plus - u_minus
  std::vector<double> pressure;  ///< multiplier mu where [u] >= 0, contact pressure; 0 elsewhere
  std::vector<double> flux;      ///< mu elsewhere: -T du/dn, n from the minus to the plus side
  std::vector<double> force;     ///< M mu of both, in the node
  /// 1: crack node that is closed under pressure; 0 also where nodes just touch (weakly active).
  std::vector<std::int32_t> contact;
};

/// u on the nodes of one subdomain.
struct Field {
  std::vector<std::int32_t> nodes;  ///< indices into Mesh::xy
  std::vector<double> u;
};

/// Positions of an interface's nodes, over which its traces are drawn.
struct TraceGeometry {
  std::vector<double> s, x, y;   ///< arc length from the interface's first node, coordinates
  std::vector<mesh::Kind> kind;  ///< condition in the node; a tip is `inclusion` or `glue` (tied)
};

}  // namespace anticrack::contact
