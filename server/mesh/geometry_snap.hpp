// SPDX-License-Identifier: GPL-3.0-or-later
//
// Ends that lie a little off their line, as rounded coordinates do on an oblique one.
#pragma once

#include <string>
#include <vector>

#include "mesh/geometry_network.hpp"

namespace anticrack::mesh {

/// A point this near to the line it must lie on is moved onto it: 1e-6 of the boundary's diagonal.
double snap_distance(const Network& network) noexcept;

/// Moves points of `geometry` that are on no line of the network within its tolerance, but within
/// snap_distance of one: ends of interfaces onto the boundary or another interface, ends of parts
/// onto an interface, those of the Neumann boundary onto the boundary. Each is told in `warnings`,
/// up to a hundred. `network`: of the same geometry. Returns whether a point was moved. O(points
/// times lines).
bool snap_ends(const Network& network, Geometry& geometry, std::vector<std::string>& warnings);

}  // namespace anticrack::mesh
