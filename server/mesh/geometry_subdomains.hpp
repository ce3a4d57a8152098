// SPDX-License-Identifier: GPL-3.0-or-later
//
// From chords with their conditions to faces, subdomains and interface chains.
#pragma once

#include <string>
#include <vector>

#include "mesh/geometry.hpp"
#include "mesh/geometry_network.hpp"

namespace anticrack::mesh {

/// Fills faces, `left` and `right` of the curves, and interfaces of a plan whose curves are the
/// chords of the network, one by one, with role, kind and inclusion set.
///
/// Glue with one subdomain on both sides is taken out of the plan; what is left of an interface are
/// its chains. Faces that only align lines part are one subdomain and carry one name. Subdomains
/// are numbered as a walk along the interfaces meets them, the minus side before the plus side.
///
/// `names`: of the interfaces. Throws errors::Error (geometry_invalid) at "interfaces[i].polyline"
/// for an interface of which nothing is left, at "regions[i].at" for a region outside, on a line,
/// or in the subdomain of another.
void lay_subdomains(const Geometry& geometry, const Network& network,
                    const std::vector<std::string>& names, Plan& plan);

}  // namespace anticrack::mesh
