// SPDX-License-Identifier: GPL-3.0-or-later
//
// The whole membrane as one sparse matrix, as somebody would set it up who does not cut it: glue is
// no interface at all, the plus side of the inclusion and its tips are one unknown A, and only the
// nodes of the open crack are there twice. Shares no code with the solver it is compared to.
#pragma once

#include <cstdint>
#include <vector>

#include "benchmarks/plain_mesh.hpp"

namespace anticrack::benchmarks {

/// What stands for the minus side of the crack.
enum class Minus {
  values,  ///< u-, with the condition A - u- >= 0
  jumps,   ///< d = A - u- >= 0: a bound, as solvers off the shelf ask for
};

/// Unknowns: free nodes, then the contacts, last the A_j. Glue and inclusions that are delaminated
/// on their minus sides from tip to tip; anything else is refused.
struct Monolithic {
  std::int32_t unknowns = 0;
  std::int32_t contacts = 0;
  std::int32_t inclusions = 0;
  std::vector<std::int32_t> above;  ///< (contacts) the inclusion on the other side
  // Upper triangle, compressed rows, columns ascending.
  std::vector<std::int32_t> first;   ///< (unknowns + 1)
  std::vector<std::int32_t> column;  ///< index base 0
  std::vector<double> value;
  std::vector<std::int32_t> corner;  ///< (3m) unknown of the triangle's corner, -1: u = 0
  Minus minus = Minus::values;

  std::int32_t interior() const noexcept { return unknowns - contacts - inclusions; }
  /// Unknown that is A_j.
  std::int32_t displacement(std::int32_t j) const noexcept { return interior() + contacts + j; }
};

/// Throws std::runtime_error for a mesh of another kind. O(m).
Monolithic assemble(const PlainMesh& mesh, Minus minus);

/// int f phi_i for f linear between its values on the nodes. (unknowns), O(m).
std::vector<double> load_vector(const PlainMesh& mesh, const Monolithic& system,
                                const std::vector<double>& nodal_force);

}  // namespace anticrack::benchmarks
