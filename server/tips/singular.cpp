// SPDX-License-Identifier: GPL-3.0-or-later
#include "tips/singular.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <tuple>

#include "base/at.hpp"

namespace anticrack::tips {
namespace {

using mesh::TipKind;
using std::numbers::pi;

/// Halves the angles, which are in [-pi, pi].
void halve(Lanes& c, Lanes& s) {
  for (std::size_t q = 0; q < c.size(); ++q) {
    const double larger = std::sqrt(0.5 * (1 + std::abs(c[q]))),
                 smaller = 0.5 * std::abs(s[q]) / larger, behind = c[q];
    c[q] = behind < 0 ? smaller : larger;
    s[q] = std::copysign(behind < 0 ? larger : smaller, s[q]);
  }
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
Lanes Singular::power(const Lanes& r) const {
  Lanes result;
  if (_exponent == 0.5)
    for (std::size_t q = 0; q < r.size(); ++q) result[q] = 1 / std::sqrt(r[q]);
  else if (_exponent == 0.25)
    for (std::size_t q = 0; q < r.size(); ++q) result[q] = 1 / std::sqrt(std::sqrt(r[q]));
  else
    for (std::size_t q = 0; q < r.size(); ++q) result[q] = std::pow(r[q], -_exponent);
  return result;
}

/// Multiplies the angles by alpha.
void Singular::turn(Lanes& c, Lanes& s) const {
  if (_exponent == 0.5 || _exponent == 0.25) {
    halve(c, s);
    if (_exponent == 0.25) halve(c, s);
    return;
  }
  for (std::size_t q = 0; q < c.size(); ++q) {
    const double angle = _exponent * std::atan2(s[q], c[q]);
    c[q] = std::cos(angle);
    s[q] = std::sin(angle);
  }
}

std::array<Lanes, 2> Singular::phi(Lanes c, Lanes s, std::size_t side) const {
  const double a = _exponent, beta = -_jump,
               all = 1 / std::sqrt(1 + beta * beta);  // cos and sin of pi a: all, beta all
  turn(c, s);
  std::array<Lanes, 2> result{};
  Lanes &phi = result[0], &phi_1 = result[1];
  const auto each = [](const auto& of) {
    for (std::size_t q = 0; q < std::tuple_size_v<Lanes>; ++q) of(q);
  };
  switch (_kind) {
    case TipKind::delaminated_end:
      each([&, plus = side == 1](std::size_t q) {
        phi[q] = plus ? all * (beta * c[q] - s[q]) : beta * all * (c[q] - beta * s[q]);
        phi_1[q] = plus ? -a * all * (c[q] + beta * s[q]) : -a * beta * all * (beta * c[q] + s[q]);
      });
      break;
    case TipKind::front:
      if (side == 1) break;
      each([&](std::size_t q) {
        phi[q] = s[q];
        phi_1[q] = c[q] / 2;
      });
      break;
    case TipKind::crack_tip:
      each([&, share = _theta_mean / _root[side]](std::size_t q) {
        phi[q] = share * s[q];
        phi_1[q] = share * c[q] / 2;
      });
      break;
    default:
      each([&](std::size_t q) {
        phi[q] = c[q];
        phi_1[q] = -s[q] / 2;
      });
      break;
  }
  return result;
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
