// SPDX-License-Identifier: GPL-3.0-or-later
//
// An estimate of what curves in place of their chords would change, from the answer on the chords.
//
// Let the curve lie V to the left of its chord. To first order the energy of the membrane on the
// left changes by -int V g, and that of the one on the right by int V g,
//
//   g = T grad u.grad u / 2 - s u_n + s G_n - f u,   s = n.T grad u,  u_n = n.grad u,
//
// with G the function at which the side is held, where it is (g_D, or the motion of an inclusion);
// g_N acts on the length of the curve anyhow. Chords of balanced areas have int V = 0 on each, so
// the roughness of the chords counts as well: a wave V of the boundary changes the energy by a part
// of 1/2 int T |grad u - grad G|^2 V |D| V, |D| the root of -d^2/ds^2. On chords of length h with
// balanced areas V is a parabola, and this is
//
//   rho/2 int T |grad u - grad G|^2 V^2 / h,   rho = 180 zeta(3) / pi^3 = 6.98.
//
// Between sides that are tied, only the jumps of T and of grad u count. A of an inclusion is minus
// the derivative of the energy by a force on it, so with z the answer to a unit force, contacts
// kept, the same forms of u and z estimate what happens to A. Derivation: THEORY.md.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "estimate/load_balance.hpp"

namespace anticrack::estimate {

/// The derivative of g_D to the left of each of CutMesh::chords, in its middle; 0 where it is not
/// on the Dirichlet boundary, or where g_D is not defined beside it. Empty: 0.
std::vector<double> slopes_across_chords(const CutMesh& cut, const std::string& boundary_value);

/// A displacement by its values in the copies.
struct BesideChords {
  std::span<const double> values;
  std::span<const double> across;  ///< slopes_across_chords of its boundary values
};

/// Estimates how far the energy of the membrane with curves is from that of the one with chords,
/// >= 0, force times length. O(chords).
double chord_gap(const CutMesh& cut, const std::vector<ddm::Subdomain>& subdomains,
                 const LoadBalance& load, const BesideChords& u);

/// The same of a displacement, to a unit force on which `z` is the answer with the contacts of u.
double chord_gap(const CutMesh& cut, const std::vector<ddm::Subdomain>& subdomains,
                 const LoadBalance& load, const BesideChords& u, const BesideChords& z);

}  // namespace anticrack::estimate
