// SPDX-License-Identifier: GPL-3.0-or-later
//
// A mesh as the server understood it: what is drawn and tabulated before anything is solved. Units
// and index base as in result.hpp.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "results/assemble.hpp"
#include "results/result.hpp"

namespace anticrack::results {

/// A chain of k nodes; its plus side is on the left. A closed one has its first node again as its
/// last.
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
  Mesh mesh;  ///< its boundary: the edges where u is prescribed
  std::vector<InterfaceLine> interfaces;
  std::vector<Tip> tips;
};

/// Adds the arrays of ReadMesh to what the message Mesh said: title, names and tension of the
/// subdomains, names of interfaces and inclusions, tips. Throws Error as `assemble` does.
MeshPlan assemble_mesh(MeshPlan messages, std::span<const ArrayView> mesh_block);

/// The first invariant above that does not hold; empty when all hold.
std::string first_fault(const MeshPlan& plan);

}  // namespace anticrack::results
