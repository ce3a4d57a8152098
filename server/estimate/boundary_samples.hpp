// SPDX-License-Identifier: GPL-3.0-or-later
//
// Boundary values g_D that are not linear along the edges of the mesh: polynomials through samples,
// and a proof of how far g_D is from them.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "estimate/cut_mesh.hpp"

namespace anticrack::estimate {

/// Whether a face lies on the Dirichlet boundary.
bool has_boundary_value(const Face& face);

/// The corners at a face's ends 0 and 1, and the third one of its triangle: indices into
/// CutMesh::copy.
std::array<std::size_t, 3> corners_of(const Face& face);

/// Samples of g_D along each such face, s = 0 ... 1, in two halves.
struct BoundarySamples {
  static constexpr std::size_t halves = 2;

  /// (faces, 2, 5) row-major: g_D at the Gauss points of the halves, from end 0 of the face.
  std::vector<double> values;
  /// (faces) >= sqrt(int (g' - p')^2 ds) with the polynomials p of the halves, by interval
  /// arithmetic. Not finite if g_D cannot be proved to be continuous with a finite derivative.
  std::vector<double> unknown;

  bool empty() const noexcept { return values.empty(); }
};

/// Samples an expression. An edge with a kink takes up to a hundred boxes
/// (expression/enclosure.hpp), another edge two. Throws errors::Error (expression_invalid, also if
/// a sample is not finite; cancelled).
BoundarySamples boundary_samples(const CutMesh& cut, const std::string& text);

}  // namespace anticrack::estimate
