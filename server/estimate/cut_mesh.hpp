// SPDX-License-Identifier: GPL-3.0-or-later
//
// The triangles of a membrane cut along its cracks and inclusions, and their fans around nodes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/large.hpp"
#include "ddm/decomposition.hpp"
#include "estimate/shapes.hpp"
#include "estimate/ways.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::estimate {

/// The condition on the outward flux w through a face.
enum class Condition : std::uint8_t {
  free,         ///< Dirichlet boundary, bonded inclusion, plus face of a delaminated one: any w
  given,        ///< Neumann boundary: w = int g; faces of a free crack: w = 0
  pressed,      ///< minus face of a delaminated inclusion: w <= 0
  crack_minus,  ///< w <= 0
  crack_plus,   ///< w is minus that through the other face
};

/// An edge that belongs to one triangle of the cut membrane. Its ends are numbered 0, 1
/// counterclockwise about the triangle.
struct Face {
  std::int32_t side = 0;  ///< 3 T + i: the edge opposite to corner i of triangle T
  Condition condition = Condition::free;
  std::int32_t inclusion = -1;  ///< index into Mesh::inclusions, or -1
  std::int32_t other = -1;      ///< face of the same edge on the other side
  std::int32_t traction = -1;   ///< index among the Neumann edges, subdomain after subdomain
};

/// Whether w <= 0 must hold, as on minus faces, whose pressure is -w.
constexpr bool presses(Condition condition) noexcept {
  return condition == Condition::pressed || condition == Condition::crack_minus;
}

/// What is on one side of an edge on a chord.
struct Beside {
  std::int32_t side = -1;  ///< 3 T + i: the edge opposite to corner i of triangle T; -1: nothing
  std::int32_t face = -1;  ///< its face; -1: the edge is inside the cut membrane
};

/// An edge on a chord of a curve, with what is on the left and on the right of it.
struct ChordEdge {
  mesh::ChordEdge edge;
  std::array<Beside, 2> beside;
};

/// Where a fan meets a face, a flux x through spoke `spoke` is the flux w = sign x through the
/// face.
struct Stop {
  std::int32_t spoke = 0;
  std::int32_t face = 0;
  std::int32_t end = 0;  ///< end of the face: 0 where the fan begins (sign -1), 1 where it ends
  double sign() const noexcept { return end == 0 ? -1 : 1; }
};

/// The side by which flux that enters a triangle of a tree goes on.
struct WayOut {
  std::int32_t side = 0;   ///< side of the triangle, 3 T + i
  std::int32_t into = -1;  ///< the same edge in the neighbour; -1: the Dirichlet boundary
};

/// Triangles T are numbered subdomain after subdomain in the order of ddm::Subdomain::triangle.
/// Nodes are numbered likewise, as "copies": a node of a crack has one on each side, a node of glue
/// one in each subdomain. Corner 3 T + i is corner i of T; side 3 T + i is the edge opposite to it.
struct CutMesh {
  std::vector<std::int32_t> first_triangle;  ///< (subdomains + 1)
  std::vector<std::int32_t> first_copy;      ///< (subdomains + 1)
  base::Large<std::int32_t> copy;            ///< (corners) the copy at each corner
  std::vector<Vector> at;                    ///< (copies) coordinates
  std::vector<std::int32_t> triangle;        ///< (triangles) index into the mesh's triangles

  std::vector<Face> faces;
  std::vector<ChordEdge> chords;  ///< as Mesh::chords
  std::vector<char> tilts;        ///< (inclusions) 1: the flux must balance its moment as well

  /// A fan has the corners about a node, counterclockwise from face to face or all round. It goes
  /// on across cracks, whose flux is the same on both faces. Spokes 0, ..., m are between its
  /// corners; in a closed fan the last spoke is the first.
  std::vector<std::int32_t> first_corner;  ///< (fans + 1) index into corners
  std::vector<std::int32_t> corners;       ///< of all fans
  std::vector<std::int32_t> first_stop;    ///< (fans + 1) index into stops
  std::vector<Stop> stops;
  /// Blocks of triangles, of equal size. The fans of block b, first_fan[b] to first_fan[b + 1] - 1,
  /// have triangles of this block alone, so that threads may work on blocks at once; the last fans
  /// have triangles of several. Blocks depend on the mesh only, not on the number of threads.
  std::vector<std::int32_t> first_fan;  ///< (blocks + 2)
  /// (triangles) The triangles of each block in the order in which its fans meet them, then those
  /// that none of its own fans has; and (fans) how many are met, in all blocks, once a fan is done.
  std::vector<std::int32_t> met, met_until;
  /// Ways from triangles to the Dirichlet boundary that cross no crack and no inclusion. A triangle
  /// comes after those that its way leads through; triangles without a way are left out.
  std::vector<WayOut> ways_out;
  Shapes shapes;
  std::vector<Vector> centre;  ///< (inclusions) the point about which its moments are taken
  Ways ways;

  /// The reason why no flux can be equilibrated fan by fan, with the place, or no bounds can be
  /// proved; empty if they can.
  std::string obstacle;

  std::size_t triangle_count() const noexcept { return triangle.size(); }
  std::size_t fan_count() const noexcept { return first_corner.size() - 1; }
  std::size_t block_count() const noexcept { return first_fan.size() - 2; }
  /// The first triangle of a block; of block_count(): the number of triangles.
  std::size_t first_of_block(std::size_t block) const noexcept {
    return triangle_count() * block / block_count();
  }
  /// Copies at ends 0 and 1 of a face.
  std::array<std::int32_t, 2> ends(const Face& face) const noexcept {
    const std::int32_t t = face.side / 3, i = face.side % 3;
    return {copy[static_cast<std::size_t>(3 * t + (i + 1) % 3)],
            copy[static_cast<std::size_t>(3 * t + (i + 2) % 3)]};
  }
  std::size_t bytes() const noexcept;
};

/// Triangles of a block whose fluxes fit in the cache of a core.
constexpr std::size_t default_block = 16384;

/// Cuts the mesh into fans, and these into blocks of about `block` triangles. O(m log m).
CutMesh cut_mesh(const mesh::Mesh& mesh, const ddm::Decomposition& decomposition,
                 std::size_t block = default_block);

}  // namespace anticrack::estimate
