// SPDX-License-Identifier: GPL-3.0-or-later
//
// A mesh as the server understood it, to be drawn before anything is solved. Units and index base
// as in result.hpp.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "results/assemble.hpp"
#include "results/result.hpp"

namespace anticrack::results {

/// A chain of k nodes with the plus side on its left; a closed one repeats its first node.
struct InterfaceLine {
  std::string name;
  std::vector<std::int32_t> nodes;  ///< (k) index into Mesh::xy
  Edges edges;
};

/// A node in which the condition along interfaces changes.
struct Tip {
  double x = 0;
  double y = 0;
  double smallest_edge = 0;  ///< of the triangles that touch it
};

struct MeshPlan {
  std::string title;
  Units units;
  Mesh mesh;  ///< its boundary: the edges where u is prescribed
  std::vector<InterfaceLine> interfaces;
  std::vector<Tip> tips;
  bool free = false;  ///< no traction acts where u is not given; false: it is not known
};

/// Adds the arrays of ReadMesh to the contents of the message Mesh: title, names and tension of the
/// subdomains, names of interfaces and inclusions, tips. Throws Error as `assemble` does.
MeshPlan assemble_mesh(MeshPlan messages, std::span<const ArrayView> mesh_block);

/// The first invariant that does not hold; empty: all hold.
std::string first_fault(const MeshPlan& plan);

}  // namespace anticrack::results
