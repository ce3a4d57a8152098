// SPDX-License-Identifier: GPL-3.0-or-later
//
// Coarse meshes of the paper's membrane to refine, and their mirror images.
#pragma once

#include "mesh/geometry.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::accuracy {

/// Squares of side 1/4 with one diagonal each; `condition` holds on (-0.5, 0.5).
mesh::Mesh diagonals(mesh::Kind condition = mesh::Kind::delaminated);

/// Rectangles of 1/6 by 1/5 with one diagonal each.
mesh::Mesh rectangles();

/// `diagonals`, its inner nodes moved at random, those on the interface along it: triangles of
/// every shape, and no edge on x = 0 but where it happens. The tips stay.
mesh::Mesh shaken(unsigned seed);

/// What the service makes of the paper's geometry with its default preset, by the helper process
/// and graded towards the tips: unstructured. `h0` is the edge length away from them, 0: the
/// default.
mesh::Mesh generated(double h0);
mesh::Mesh generated(const mesh::MeshOptions& options);
/// The same of another geometry.
mesh::Mesh generated(const mesh::Geometry& geometry, const mesh::MeshOptions& options);

enum class Mirror { x, y };

/// The image under x -> -x or y -> -y. Nodes, triangles and edges keep their numbers; the chain of
/// each interface is turned round, so that the image of its plus side is its plus side.
mesh::Mesh mirrored(mesh::Mesh mesh, Mirror mirror);

/// Plus and minus sides exchanged.
mesh::Mesh turned(mesh::Mesh mesh);

/// Turns about the origin and scales: a point, or all nodes of a mesh.
class Placement {
 public:
  Placement(double angle, double scale);
  mesh::Point operator()(const mesh::Point& p) const;
  mesh::Mesh operator()(mesh::Mesh mesh) const;

 private:
  double _cos, _sin;
};

}  // namespace anticrack::accuracy
