// SPDX-License-Identifier: GPL-3.0-or-later
//
// The solution next to a tip. With X, Y as in Flattened and polar coordinates r, theta of them, the
// interface behind the tip at theta = +-pi, the plus side at theta > 0, D = sqrt(det T):
//
//   delaminated end   A - c s,  s = r^alpha {sin alpha (pi - theta); beta cos alpha (pi + theta)},
//                     alpha = arctan(beta) / pi,  beta = sqrt(D+/D-)
//   front             A + c {0; r^1/2 sin(theta/2)}
//   crack tip         u0 + c (Th/D+-) r^1/2 sin(theta/2),  Th = 2 D+ D- / (D+ + D-)
//   bonded end        A + c r^1/2 cos(theta/2)
//
// (plus side; minus side). The dual function s* has r^-alpha in place of r^alpha.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "mesh/tip_kind.hpp"
#include "tips/places.hpp"
#include "tips/tensor.hpp"

namespace anticrack::tips {

/// Numbers of eight points, which are worked on at once.
using Lanes = std::array<double, 8>;

class Singular {
 public:
  /// `minus`, `plus`: T at the tip on both sides, in coordinates (s, d) along and across. The kind
  /// is not `other`.
  Singular(mesh::TipKind kind, const Tensor& minus, const Tensor& plus);

  double exponent() const noexcept { return _exponent; }
  /// int D phi^2 over the angle, phi = s*/r^-alpha.
  double norm() const noexcept { return _norm; }
  /// phi and its derivative in the directions (c, s) = (X, Y) / r; `side` 0: minus, 1: plus.
  std::array<Lanes, 2> phi(Lanes c, Lanes s, std::size_t side) const;
  /// r^-alpha.
  Lanes power(const Lanes& r) const;
  /// [phi] on the faces.
  double jump() const noexcept { return _jump; }
  /// 1, or -1 where the solution has -c s.
  double sign() const noexcept { return _sign; }
  /// |c| of a rate of the energy when the tip moves ahead; for every kind but a delaminated end,
  /// where a rate says nothing of c.
  double intensity_of(double rate) const;
  /// K_III = lim (2 pi r)^1/2 T du/dn ahead of a crack tip.
  double k_iii(double intensity) const;
  /// Of an open delaminated end: G l^(1 - 2 alpha) = 2 pi alpha^2 D+ c^2 / 16^alpha of a short
  /// crack of length l that leaves it straight ahead (THEORY.md).
  double release_factor(double intensity) const;

 private:
  void turn(Lanes& c, Lanes& s) const;

  mesh::TipKind _kind;
  std::array<double, 2> _root;  ///< D of the minus and the plus side
  double _exponent = 0.5, _norm = 0, _jump = 0, _sign = 1, _theta_mean = 0;
};

/// Of a place whose kind is not `other`.
Singular singular_at(const Place& place, std::span<const Law> laws);
/// T at the tip on the minus and the plus side, in coordinates along and across the course.
std::array<Tensor, 2> tensors_at(const Place& place, std::span<const Law> laws);

/// The least exponent of the ends of delaminated inclusions: 1/4, but for where the tensions of the
/// sides differ. Throws errors::Error (expression_invalid). O(m log m) where they do.
double least_exponent(const mesh::Mesh& mesh);

}  // namespace anticrack::tips
