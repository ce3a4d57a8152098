// SPDX-License-Identifier: GPL-3.0-or-later
//
// From a .msh file to a mesh, by its physical groups.
//
// Surfaces: every physical surface is a subdomain, called by its name or its number, in the order
// of the numbers; without physical surfaces every elementary surface is one. Curves, by the name of
// their physical group: `dirichlet` (u = g_D), `neumann` (nothing prescribed), `crack` or
// `crack:NAME`, `inclusion:NAME` (bonded), `delaminated:NAME` (delaminated on its minus side; with
// `inclusion:NAME` one inclusion of the same name). What has no name is glue between two
// subdomains; on the boundary it is natural, but dirichlet if no curve of the file is called so.
//
// Plus side of an interface, the first of these that decides:
//   1. the surface called `plus`, or the one facing the surface called `minus`;
//   2. what lies left of the curve, if all its lines in the file run the same way;
//   3. the surface with the higher number.
#pragma once

#include <string_view>

#include "mesh/codec.hpp"
#include "mesh/mesh.hpp"
#include "mesher/msh_file.hpp"

namespace anticrack::mesher {

/// Reads the file of the request. Throws errors::Error: mesh_invalid, limit_exceeded.
mesh::Mesh import_msh(const mesh::ImportRequest& request);

/// Understands what was read. The result satisfies mesh::validate. O(m log m).
mesh::Mesh to_mesh(const MshFile& file);

}  // namespace anticrack::mesher
