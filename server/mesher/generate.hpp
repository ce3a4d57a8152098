// SPDX-License-Identifier: GPL-3.0-or-later
//
// From a plan to a mesh with gmsh. The only file that uses gmsh.
#pragma once

#include "mesh/codec.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::mesher {

/// gmsh, silent and on one thread. The constructor reads files (preferences), later calls do not.
/// One per process: gmsh is global.
class Gmsh {
 public:
  /// Starts gmsh.
  Gmsh();
  ~Gmsh();
  Gmsh(const Gmsh&) = delete;
  Gmsh& operator=(const Gmsh&) = delete;
};

/// Meshes every face of the plan, ungraded, a fine one by halving a coarse mesh (coarsening.hpp);
/// faces with the same name are one subdomain. The nodes of every planned curve lie at
/// a + (b-a) k/n, n at least its intervals, and just as many without halving. Deterministic. One
/// call per process. Throws errors::Error: limit_exceeded (too many triangles), mesher_failed (gmsh
/// failed).
mesh::Mesh generate(const Gmsh& gmsh, const mesh::GenerateRequest& request);

}  // namespace anticrack::mesher
