// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/chord_gap.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/at.hpp"
#include "errors/errors.hpp"
#include "expression/function.hpp"
#include "fem/load_vector.hpp"
#include "stop/stop.hpp"

namespace anticrack::estimate {
namespace {

/// 180 zeta(3) / pi^3, and two fifths more for gradients of meshes with one edge on a chord.
constexpr double rho = 1.4 * 6.978;

Vector offset_of(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1]}; }

/// A symmetric matrix xx, xy, yy times a vector.
Vector times(const std::array<double, 3>& m, const Vector& v) {
  return {m[0] * v[0] + m[1] * v[1], m[1] * v[0] + m[2] * v[1]};
}

/// The slope of each inclusion that tilts, by least squares from the values on the sides that it
/// holds; 0 for others, and across a straight one.
std::vector<Vector> slopes_of(const CutMesh& cut, std::span<const double> values) {
  std::vector<Vector> slopes(cut.tilts.size(), Vector{});
  struct Sums {
    double count = 0, x = 0, y = 0, v = 0, xx = 0, xy = 0, yy = 0, xv = 0, yv = 0;
  };
  std::vector<Sums> sums(cut.tilts.size());
  if (std::ranges::count(cut.tilts, 0) == std::ssize(cut.tilts)) return slopes;
  for (const Face& face : cut.faces) {
    if (face.inclusion < 0 || face.condition != Condition::free) continue;
    for (const std::int32_t copy : cut.ends(face)) {
      const auto [x, y] = offset_of(cut.at[at(copy)], cut.centre[at(face.inclusion)]);
      const double v = values[at(copy)];
      Sums& s = sums[at(face.inclusion)];
      s = {s.count + 1,  s.x + x,      s.y + y,      s.v + v,     s.xx + x * x,
           s.xy + x * y, s.yy + y * y, s.xv + x * v, s.yv + y * v};
    }
  }
  for (std::size_t j = 0; j < sums.size(); ++j) {
    const Sums& s = sums[j];
    if (cut.tilts[j] == 0 || s.count == 0) continue;
    const double xx = s.xx - s.x * s.x / s.count, xy = s.xy - s.x * s.y / s.count,
                 yy = s.yy - s.y * s.y / s.count, xv = s.xv - s.x * s.v / s.count,
                 yv = s.yv - s.y * s.v / s.count, determinant = xx * yy - xy * xy;
    if (determinant > 1e-9 * (xx + yy) * (xx + yy))
      slopes[j] = {(yy * xv - xy * yv) / determinant, (xx * yv - xy * xv) / determinant};
  }
  return slopes;
}

/// A displacement with the slopes of its inclusions.
struct Displacement {
  BesideChords of;
  std::vector<Vector> slopes;
};

/// A displacement on one side of an edge; n is the unit normal to the left of the edge.
struct OnSide {
  double at_a = 0, at_b = 0;  ///< values
  Vector gradient{}, flux{};  ///< T grad
  double slope = 0;           ///< n.gradient
  double through = 0;         ///< n.flux
  double given = 0;           ///< slope of the function at which the side is held
  double rough = 0;           ///< root of T |grad u - grad G|^2
};

class ChordGap {
 public:
  ChordGap(const CutMesh& cut, const std::vector<ddm::Subdomain>& subdomains,
           const LoadBalance& load, const BesideChords& u, const BesideChords& z)
      : _cut(cut),
        _subdomains(subdomains),
        _load(load),
        _u{u, slopes_of(cut, u.values)},
        _z{z, slopes_of(cut, z.values)} {
    for (const double one : u.values) _touching = std::max(_touching, 1e-12 * std::abs(one));
  }

  /// `part` of the forms of u and z, with all of the work of f on z.
  double operator()(double part) {
    double first = 0, second = 0;
    for (std::size_t i = 0; i < _cut.chords.size(); ++i) {
      stop::look_at_turn(i, "estimating what chords change");
      const ChordEdge& chord = _cut.chords[i];
      const bool two = chord.beside[0].side >= 0 && chord.beside[1].side >= 0;
      if (two && tied(chord)) {
        if (tension_of(chord.beside[0]) == tension_of(chord.beside[1])) continue;
        second += part * rho * square(chord) * jumps(i);
      }
      for (const std::size_t side : {0, 1}) {
        if (chord.beside[side].side < 0) continue;
        const OnSide u = on_side(i, side, _u), z = on_side(i, side, _z);
        const double out = side == 0 ? -1 : 1;
        const double form = dot(u.flux, z.gradient) - u.through * (z.slope - z.given) -
                            z.through * (u.slope - u.given);
        first += part * out * mean(chord, 1, 1) * form + out * work(chord, side, z);
        if (!two || !tied(chord)) second += part * rho * square(chord) * u.rough * z.rough;
      }
    }
    return std::abs(first) + second;
  }

 private:
  std::size_t end(const Beside& beside, std::size_t k) const {  // 0, 1: counterclockwise
    const auto t = at(beside.side / 3), i = at(beside.side % 3);
    return at(_cut.copy[3 * t + (i + 1 + k) % 3]);
  }
  /// The copies at a and b: on the right of the edge its triangle is walked from b to a.
  std::array<std::size_t, 2> ends(const ChordEdge& chord, std::size_t side) const {
    return {end(chord.beside[side], side), end(chord.beside[side], 1 - side)};
  }
  Vector along(const ChordEdge& chord) const {
    const std::size_t side = chord.beside[0].side >= 0 ? 0 : 1;
    const auto [a, b] = ends(chord, side);
    return offset_of(_cut.at[b], _cut.at[a]);
  }

  /// int V v over the edge, v linear with the values a and b at its ends.
  double mean(const ChordEdge& chord, double a, double b) const {
    const auto& e = chord.edge;
    const Vector d = along(chord);
    return std::hypot(d[0], d[1]) / 6 * (e.at_a * a + 2 * e.at_middle * (a + b) + e.at_b * b);
  }
  /// int V^2 / h over the edge.
  double square(const ChordEdge& chord) const {
    const auto& [i, j, a, m, b, length, stretch] = chord.edge;
    const Vector d = along(chord);
    return std::hypot(d[0], d[1]) / (30 * length) *
           (4 * (a * a + b * b) + 16 * m * m + 4 * m * (a + b) - 2 * a * b);
  }

  bool closed(const ChordEdge& chord) const {
    const auto left = ends(chord, 0), right = ends(chord, 1);
    return std::ranges::all_of(std::array{0, 1}, [&](int k) {
      return std::abs(_u.of.values[left[at(k)]] - _u.of.values[right[at(k)]]) <= _touching;
    });
  }
  /// Whether both sides have one value and one flux: glue, or a closed crack.
  bool tied(const ChordEdge& chord) const {
    const std::int32_t face = chord.beside[0].face;
    if (face < 0) return true;
    const Condition condition = _cut.faces[at(face)].condition;
    return (condition == Condition::crack_minus || condition == Condition::crack_plus) &&
           closed(chord);
  }

  std::array<double, 3> tension_of(const Beside& beside) const {
    const auto t = beside.side / 3;
    const auto after = std::ranges::upper_bound(_cut.first_triangle, t);
    const auto s = at(static_cast<int>(after - _cut.first_triangle.begin()) - 1);
    const fem::Tension& tension = _subdomains[s].tension;
    if (tension.of_triangle.empty()) return {tension.mean, 0, tension.mean};
    return tension.of_triangle[at(t - _cut.first_triangle[s])];
  }

  Vector gradient(std::size_t t, std::span<const double> values) const {
    Vector sum{};
    double twice_area = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto corner = [&](std::size_t k) { return at(_cut.copy[3 * t + (i + k) % 3]); };
      const Vector side = offset_of(_cut.at[corner(2)], _cut.at[corner(1)]);
      sum[0] -= side[1] * values[corner(0)];
      sum[1] += side[0] * values[corner(0)];
      if (i == 0) {
        const Vector other = offset_of(_cut.at[corner(0)], _cut.at[corner(1)]);
        twice_area = side[0] * other[1] - side[1] * other[0];
      }
    }
    return {sum[0] / twice_area, sum[1] / twice_area};
  }

  /// The slope of the function at which a side is held; none where it is not.
  std::optional<double> held(std::size_t i, std::size_t side, const Vector& n,
                             const Displacement& v) const {
    const ChordEdge& chord = _cut.chords[i];
    if (chord.beside[side].face < 0) return std::nullopt;
    const Face& face = _cut.faces[at(chord.beside[side].face)];
    const bool closes = face.condition == Condition::pressed && closed(chord);
    if (face.condition != Condition::free && !closes) return std::nullopt;
    if (face.inclusion >= 0) return dot(n, v.slopes[at(face.inclusion)]);
    return v.of.across.empty() ? 0 : v.of.across[i];
  }

  OnSide on_side(std::size_t i, std::size_t side, const Displacement& v) const {
    const ChordEdge& chord = _cut.chords[i];
    const Vector d = along(chord);
    const double length = std::hypot(d[0], d[1]);
    const Vector n{-d[1] / length, d[0] / length};
    const auto [a, b] = ends(chord, side);
    OnSide result{v.of.values[a], v.of.values[b]};
    const std::array<double, 3> tension = tension_of(chord.beside[side]);
    result.gradient = gradient(at(chord.beside[side].side / 3), v.of.values);
    result.flux = times(tension, result.gradient);
    result.slope = dot(n, result.gradient);
    result.through = dot(n, result.flux);
    const std::optional<double> given = held(i, side, n, v);
    result.given = given.value_or(0);
    result.rough =
        given ? std::sqrt(dot(n, times(tension, n))) * std::abs(result.slope - result.given)
              : std::sqrt(std::max(0.0, dot(result.flux, result.gradient)));
    return result;
  }

  /// What roughness multiplies between tied sides of tensions S and T:  S T / (S + T) [u_n] [z_n] +
  /// (S - T)^2 / (S + T) u_s z_s, all without their signs.
  double jumps(std::size_t i) const {
    const ChordEdge& chord = _cut.chords[i];
    const double s = _cut.shapes.tension[at(chord.beside[0].side / 3)],
                 t = _cut.shapes.tension[at(chord.beside[1].side / 3)];
    const OnSide u = on_side(i, 0, _u), over = on_side(i, 1, _u), z = on_side(i, 0, _z),
                 under = on_side(i, 1, _z);
    const Vector d = along(chord);
    const double squared = dot(d, d);
    return s * t / (s + t) * std::abs((u.slope - over.slope) * (z.slope - under.slope)) +
           (s - t) * (s - t) / (s + t) * std::abs((u.at_b - u.at_a) * (z.at_b - z.at_a)) / squared;
  }

  /// -int V f z.
  double work(const ChordEdge& chord, std::size_t side, const OnSide& z) const {
    if (_load.force.empty()) return 0;
    const auto t = at(chord.beside[side].side / 3);
    const double f = (_load.force[3 * t] + _load.force[3 * t + 1] + _load.force[3 * t + 2]) /
                     _cut.shapes.area[t];
    return -f * mean(chord, z.at_a, z.at_b);
  }

  const CutMesh& _cut;
  const std::vector<ddm::Subdomain>& _subdomains;
  const LoadBalance& _load;
  const Displacement _u, _z;
  double _touching = 0;  // a jump up to this is rounding
};

}  // namespace

std::vector<double> slopes_across_chords(const CutMesh& cut, const std::string& boundary_value) {
  if (cut.chords.empty() || boundary_value.empty()) return {};
  constexpr double step = 1e-4;  // of the edge
  const expression::Function g(boundary_value, "boundary_value");
  std::vector<double> slopes(cut.chords.size(), 0);
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    stop::look_at_turn(i, "estimating what chords change");
    for (const std::size_t side : {0, 1}) {
      const auto& [number, face] = cut.chords[i].beside[side];
      if (face < 0) continue;
      const Face& of = cut.faces[at(face)];
      if (of.condition != Condition::free || of.inclusion >= 0) continue;
      const auto [first, last] = cut.ends(of);
      const Vector &p = cut.at[at(first)], &q = cut.at[at(last)], d = offset_of(q, p),
                   m{(p[0] + q[0]) / 2, (p[1] + q[1]) / 2};
      const double length = std::hypot(d[0], d[1]), in = side == 0 ? 1 : -1;  // to the left
      try {
        const double there = g(m[0] - step * d[1], m[1] + step * d[0]), here = g(m[0], m[1]);
        slopes[i] = in * (there - here) / (step * length);
      } catch (const errors::Error&) {
        continue;  // not defined there
      }
    }
  }
  return slopes;
}

double chord_gap(const CutMesh& cut, const std::vector<ddm::Subdomain>& subdomains,
                 const LoadBalance& load, const BesideChords& u) {
  return ChordGap(cut, subdomains, load, u, u)(0.5);
}

double chord_gap(const CutMesh& cut, const std::vector<ddm::Subdomain>& subdomains,
                 const LoadBalance& load, const BesideChords& u, const BesideChords& z) {
  return ChordGap(cut, subdomains, load, u, z)(1);
}

}  // namespace anticrack::estimate
