// SPDX-License-Identifier: GPL-3.0-or-later
//
// Makes a mesh from a plan with gmsh. Only this part uses gmsh.
#pragma once

#include "mesh/codec.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::mesher {

/// gmsh, silent and on one thread. The constructor reads files (preferences); later calls do not.
/// Make one per process, as gmsh is global.
class Gmsh {
 public:
  /// Starts gmsh.
  Gmsh();
  ~Gmsh();
  Gmsh(const Gmsh&) = delete;
  Gmsh& operator=(const Gmsh&) = delete;
};

/// Meshes every face of the plan, without grading; a fine mesh is made by halving a coarse one
/// (coarsening.hpp). Faces with the same name are one subdomain. The nodes of every planned curve
/// lie at a + (b-a) k/n with n at least its intervals, and equal to them without halving.
/// Deterministic. One call per process. Throws errors::Error: limit_exceeded (too many triangles),
/// mesher_failed (gmsh failed).
mesh::Mesh generate(const Gmsh& gmsh, const mesh::GenerateRequest& request);

}  // namespace anticrack::mesher
