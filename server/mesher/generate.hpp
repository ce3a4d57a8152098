// SPDX-License-Identifier: GPL-3.0-or-later
//
// From a plan to a mesh, by gmsh. The only file that sees it.
#pragma once

#include "mesh/codec.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::mesher {

/// gmsh, ready for a model. Making it looks for files (preferences), using it does not.
/// One a process: gmsh is global.
class Gmsh {
 public:
  /// Starts gmsh, silent and on one thread.
  Gmsh();
  ~Gmsh();
  Gmsh(const Gmsh&) = delete;
  Gmsh& operator=(const Gmsh&) = delete;
};

/// Meshes every face of the plan; it is not graded yet. Faces of one name are one subdomain. The
/// nodes of every planned curve lie exactly at a + (b-a) k/n. The same request gives the same mesh.
/// One call a process. Throws errors::Error: limit_exceeded (more triangles than asked for),
/// mesher_failed (gmsh gave up).
mesh::Mesh generate(const Gmsh& gmsh, const mesh::GenerateRequest& request);

}  // namespace anticrack::mesher
