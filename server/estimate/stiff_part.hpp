// SPDX-License-Identifier: GPL-3.0-or-later
//
// The part of a membrane where T is larger than elsewhere by powers of ten. With Omega_t the stiff
// part, Omega_s the rest, Gamma the edges between them, and C so large that each w on Omega_t that
// is 0 on the Dirichlet boundary has a continuation E w into Omega_s, continuous across its cracks,
// 0 on its Dirichlet boundary and its inclusions, with
//
//   |grad E w|_s <= C |grad w|_t   (T = 1),
//
// the error e = u - v, S = T grad u - sigma, D and m of interval.hpp obey
//
//   int_t T (|m|^2 - |D|^2) + X_t - P_t = - int_s S . grad E e = - (the same with s),
//   |int_s S . grad E e| <= coupling (|m|_t + |D|_t) (|m|_s + |D|_s),
//
// with `coupling` = C sqrt(max T on Omega_s / min T on Omega_t): what the error is in one part
// hardly reaches the other (THEORY.md). Contacts with a side in Omega_s belong to that part.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "estimate/cut_mesh.hpp"

namespace anticrack::estimate {

struct StiffPart {
  std::vector<char> has;    ///< (triangles) whether the triangle is in it
  double continuation = 0;  ///< C
  double coupling = 0;

  /// Whether both sides of a face lie in it.
  bool has_face(const CutMesh& cut, const Face& face) const {
    const auto in = [&](const Face& one) {
      return has[static_cast<std::size_t>(one.side / 3)] != 0;
    };
    return in(face) && (face.other < 0 || in(cut.faces[static_cast<std::size_t>(face.other)]));
  }
};

/// Least ratio of the tensions for which a part is looked for.
constexpr double least_contrast = 100;

/// The part with the largest ratio of tensions for which C is known. None if no ratio is large, or
/// if on Gamma
///   - more than two parts meet in a node, or a free end of Omega_t the Dirichlet boundary of
///     Omega_s, where there is no C;
///   - a slit of Omega_t or an inclusion of Omega_s ends, or the minus side of a delaminated
///     inclusion lies in Omega_t;
/// if a body lies in both parts off Gamma, or if Omega_t has an island that is tied to others by
/// contact or by a body, or held; or if Gamma or the membrane has too many edges. Factorises both
/// parts.
std::optional<StiffPart> stiff_part(const mesh::Mesh& mesh, const ddm::Decomposition& decomposition,
                                    const CutMesh& cut);

}  // namespace anticrack::estimate
