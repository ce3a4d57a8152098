// SPDX-License-Identifier: GPL-3.0-or-later
#include "tips/singular.hpp"

#include <cmath>
#include <numbers>

namespace anticrack::tips {
namespace {

using contact::TipKind;
using std::numbers::pi;

}  // namespace

Singular::Singular(TipKind kind, const Tensor& minus, const Tensor& plus)
    : _kind(kind), _root{root_of_determinant(minus), root_of_determinant(plus)} {
  const auto [below, above] = _root;
  _theta_mean = 2 * below * above / (below + above);
  switch (kind) {
    case TipKind::delaminated_end:
      _exponent = std::atan(std::sqrt(above / below)) / pi;
      _norm = pi * above;
      _jump = -std::sqrt(above / below);
      _sign = -1;
      break;
    case TipKind::front:
      _norm = pi * below / 2;
      _jump = 1;
      break;
    case TipKind::crack_tip:
      _norm = pi * _theta_mean;
      _jump = 2;
      break;
    default:
      _norm = pi * (below + above) / 2;
      break;
  }
}

std::array<double, 2> Singular::phi(double theta, std::size_t side) const {
  const double a = _exponent;
  switch (_kind) {
    case TipKind::delaminated_end: {
      if (side == 1) return {std::sin(a * (pi - theta)), -a * std::cos(a * (pi - theta))};
      const double beta = -_jump;
      return {beta * std::cos(a * (pi + theta)), -a * beta * std::sin(a * (pi + theta))};
    }
    case TipKind::front:
      if (side == 1) return {0, 0};
      return {std::sin(theta / 2), std::cos(theta / 2) / 2};
    case TipKind::crack_tip: {
      const double share = _theta_mean / _root[side];
      return {share * std::sin(theta / 2), share * std::cos(theta / 2) / 2};
    }
    default:
      return {std::cos(theta / 2), -std::sin(theta / 2) / 2};
  }
}

double Singular::intensity_of(double rate) const {
  const auto [below, above] = _root;
  const double share = _kind == TipKind::front       ? below / 8
                       : _kind == TipKind::crack_tip ? _theta_mean / 4
                                                     : (below + above) / 8;
  return std::sqrt(std::abs(rate) / (pi * share));
}

double Singular::k_iii(double intensity) const {
  return intensity * _theta_mean * std::sqrt(pi / 2);
}

}  // namespace anticrack::tips
