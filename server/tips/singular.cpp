// SPDX-License-Identifier: GPL-3.0-or-later
#include "tips/singular.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/at.hpp"

namespace anticrack::tips {
namespace {

using mesh::TipKind;
using std::numbers::pi;

/// The direction of half the angle, which is in [-pi, pi].
Point half(const Point& direction) {
  const auto [c, s] = direction;
  const double larger = std::sqrt(0.5 * (1 + std::abs(c))), smaller = 0.5 * std::abs(s) / larger;
  return {c < 0 ? smaller : larger, std::copysign(c < 0 ? larger : smaller, s)};
}

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

// Most exponents are 1/2 or 1/4, and roots take a fifth of the time of angles and powers.
double Singular::power(double r) const {
  if (_exponent == 0.5) return 1 / std::sqrt(r);
  if (_exponent == 0.25) return 1 / std::sqrt(std::sqrt(r));
  return std::pow(r, -_exponent);
}

/// The direction of alpha times the angle.
Point Singular::turned(const Point& direction) const {
  if (_exponent == 0.5) return half(direction);
  if (_exponent == 0.25) return half(half(direction));
  const double angle = _exponent * std::atan2(direction[1], direction[0]);
  return {std::cos(angle), std::sin(angle)};
}

std::array<double, 2> Singular::phi(const Point& direction, std::size_t side) const {
  const double a = _exponent;
  const auto [c, s] = turned(direction);
  switch (_kind) {
    case TipKind::delaminated_end: {
      const double beta = -_jump,
                   all = 1 / std::sqrt(1 + beta * beta);  // cos and sin of pi a: all, beta all
      if (side == 1) return {all * (beta * c - s), -a * all * (c + beta * s)};
      return {beta * all * (c - beta * s), -a * beta * all * (beta * c + s)};
    }
    case TipKind::front:
      if (side == 1) return {0, 0};
      return {s, c / 2};
    case TipKind::crack_tip: {
      const double share = _theta_mean / _root[side];
      return {share * s, share * c / 2};
    }
    default:
      return {c, -s / 2};
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

double Singular::release_factor(double intensity) const {
  return 2 * pi * std::pow(_exponent * intensity, 2) * _root[1] / std::pow(16, _exponent);
}

std::array<Tensor, 2> tensors_at(const Place& place, std::span<const Law> laws) {
  std::array<Tensor, 2> result{};
  for (std::size_t side = 0; side < 2; ++side) {
    const Tensor t = laws[at(place.subdomain[side])].at(place.course.tip);
    const Point a = product(t, place.course.ahead), b = product(t, place.course.normal);
    result[side] = {dot(a, place.course.ahead), dot(a, place.course.normal),
                    dot(b, place.course.normal)};
  }
  return result;
}

Singular singular_at(const Place& place, std::span<const Law> laws) {
  const auto [minus, plus] = tensors_at(place, laws);
  return {place.kind, minus, plus};
}

double least_exponent(const mesh::Mesh& mesh) {
  double least = 0.25;
  const bool one_tension =
      mesh.tension_laws.empty() &&
      std::ranges::adjacent_find(mesh.tension, std::not_equal_to<>()) == mesh.tension.end();
  if (one_tension) return least;
  const mesh::EdgeTable edges(mesh.triangles);
  const std::vector<Law> laws = laws_of(mesh);
  for (const Place& place : find_places(mesh, edges, mesh::edge_ends(mesh, edges)))
    if (place.kind == TipKind::delaminated_end && place.reason.empty())
      least = std::min(least, singular_at(place, laws).exponent());
  return least;
}

}  // namespace anticrack::tips
