// SPDX-License-Identifier: GPL-3.0-or-later
//
// From chords with their conditions to faces, subdomains and interface chains.
#pragma once

#include <string>
#include <vector>

#include "mesh/geometry.hpp"
#include "mesh/geometry_network.hpp"

namespace anticrack::mesh {

/// Fills the faces, `left` and `right` of the curves and the interfaces of a plan whose curves are
/// the chords of the network, one by one, with role, kind and inclusion set. Glue with the same
/// subdomain on both sides is removed; an interface becomes the chains that are left of it. Faces
/// separated by align lines only are one subdomain and share its name. Subdomains are numbered in
/// the order in which a walk along the interfaces meets them, minus side first. `names`: of the
/// interfaces. Throws errors::Error (geometry_invalid) at "interfaces[i].polyline" for an interface
/// of which nothing is left, at "regions[i].at" for a region outside the membrane, on a line, or in
/// a subdomain that another region names.
void lay_subdomains(const Geometry& geometry, const Network& network,
                    const std::vector<std::string>& names, Plan& plan);

}  // namespace anticrack::mesh
