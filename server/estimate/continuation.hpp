// SPDX-License-Identifier: GPL-3.0-or-later
//
// How much functions on a part of a membrane grow when they are continued into the rest.
#pragma once

#include <vector>

#include "estimate/cut_mesh.hpp"

namespace anticrack::estimate {

/// C of stiff_part.hpp for the triangles with `stiff` 1, proved for all of H1 (THEORY.md); negative
/// if none is known. Throws errors::Error (numerical) where contact alone holds a piece. Factorises
/// both parts: O(m log m), and cubic in the edges between them, of which there are at most 1,000.
double continuation(const mesh::Mesh& mesh, const CutMesh& cut, const std::vector<char>& stiff);

}  // namespace anticrack::estimate
