// SPDX-License-Identifier: GPL-3.0-or-later
//
// A mesh as every program of the benchmarks reads it, ours and the peers': plain arrays in a plain
// file. Nothing of the project is needed to read it, so that a peer shares no code with what it is
// compared to.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace anticrack::benchmarks {

/// Conditions on an edge; the numbers are those of mesh::Kind.
constexpr std::int32_t kind_glue = 1, kind_delaminated = 4;

/// An index >= 0 of an array, as a container wants it.
constexpr std::size_t at(std::int64_t i) noexcept { return static_cast<std::size_t>(i); }

/// As mesh::Mesh, tension 1: plus side on the left of a chain, index base 0.
struct PlainMesh {
  struct Chain {
    std::vector<std::int32_t> nodes;      ///< (k)
    std::vector<std::int32_t> kind;       ///< (k-1)
    std::vector<std::int32_t> inclusion;  ///< (k-1), -1: none
  };
  std::vector<double> xy;               ///< (n,2) row-major
  std::vector<std::int32_t> triangles;  ///< (m,3) row-major, counterclockwise
  std::vector<std::int32_t> subdomain;  ///< (m)
  std::vector<std::int32_t> dirichlet;  ///< (e,2) row-major, edges where u = 0
  std::vector<Chain> chains;

  std::size_t node_count() const noexcept { return xy.size() / 2; }
  std::size_t triangle_count() const noexcept { return triangles.size() / 3; }
};

/// "ACMESH1\n", the lengths of xy, triangles, subdomain, dirichlet and chains as i64, these arrays
/// (f64, i32), then each chain: k as i64, nodes, kind, inclusion. Little-endian as the machine.
/// Throws std::runtime_error where the file cannot be written.
void write(const PlainMesh& mesh, const std::string& path);

/// Throws std::runtime_error where the file cannot be read, is no such file or is cut short.
PlainMesh read_plain_mesh(const std::string& path);

/// Force per area of load case `number` in a point: smooth, another one for each number; some
/// close the crack in part. Peers that cannot call this repeat the formula.
double force(int number, double x, double y);

/// The same on the nodes: f is linear between them, so all programs integrate it exactly.
std::vector<double> nodal_force(const PlainMesh& mesh, int number);

/// Coefficient of load `j` in combination `row`: neighbouring rows are alike.
double combination(int row, int j);

}  // namespace anticrack::benchmarks
