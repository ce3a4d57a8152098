// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/weight.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>

#include "base/at.hpp"
#include "stop/stop.hpp"

namespace anticrack::estimate {
namespace {

constexpr const char* weighing = "weighing the ends of contact";

/// Relative size of rounding errors in places, which are bisected from straight lines.
constexpr double rounding = 1e-10;

Vector between(const Vector& a, const Vector& b) { return {b[0] - a[0], b[1] - a[1]}; }
double size_of(const Vector& a) { return std::sqrt(dot(a, a)); }

/// Distance of the origin from the segment ab.
double distance(const Vector& a, const Vector& b) {
  const Vector d = between(a, b);
  const double square = dot(d, d);
  const double t = square > 0 ? std::clamp(-dot(a, d) / square, 0.0, 1.0) : 0;
  return size_of({a[0] + t * d[0], a[1] + t * d[1]});
}

std::array<Vector, 2> places(const CutMesh& cut, std::size_t face) {
  const auto ends = cut.ends(cut.faces[face]);
  return {cut.at[at(ends[0])], cut.at[at(ends[1])]};
}

/// The outward normal of a face with these ends, which go counterclockwise, as long as the face.
Vector normal_of(const Vector& a, const Vector& b) { return {b[1] - a[1], a[0] - b[0]}; }

/// p on a minus face, of which the flux through its ends has the parts p_0 and p_1, times the
/// length of the face.
struct Pressure {
  double part[2];
  double sum() const { return part[0] + part[1]; }
};
Pressure pressure_of(const EquilibratedFlux& sigma, std::size_t face) {
  const double* through = &sigma.through_faces()[2 * face];
  return {{std::max(0.0, -through[0]), std::max(0.0, -through[1])}};
}

/// A minus face of a straight stretch of an inclusion, with the coordinates of its ends along it.
struct Stretch {
  std::size_t face;
  double from, to;  ///< from < to
};

/// The faces along the straight line through the end, in the order of their distance: those of the
/// side of the closed zone, or the others, with positive coordinates away from the end.
std::vector<Stretch> line_from(const CutMesh& cut, const ContactEnd& end, double direction) {
  std::vector<Stretch> line;
  const std::int32_t inclusion = cut.faces[end.face].inclusion;
  for (std::size_t f = 0; f < cut.faces.size(); ++f) {
    const Face& face = cut.faces[f];
    if (face.condition != Condition::pressed || face.inclusion != inclusion) continue;
    const auto [a, b] = places(cut, f);
    const Vector p = between(end.place, a), q = between(end.place, b);
    const double size = std::max(size_of(p), size_of(q));
    if (!(dot(normal_of(a, b), end.normal) > 0)) continue;  // its minus side is the other one
    if (std::max(std::abs(dot(p, end.normal)), std::abs(dot(q, end.normal))) > rounding * size)
      continue;
    const double s = direction * dot(p, end.along), t = direction * dot(q, end.along);
    if (std::max(s, t) > rounding * size) line.push_back({f, std::min(s, t), std::max(s, t)});
  }
  std::ranges::sort(line, [](const Stretch& a, const Stretch& b) { return a.from < b.from; });
  // Keep what is joined to the end without a gap.
  double reached = 0;
  std::size_t joined = 0;
  for (; joined < line.size(); ++joined) {
    if (std::abs(line[joined].from - reached) > rounding * line[joined].to) break;
    reached = line[joined].to;
  }
  line.resize(joined);
  return line;
}

/// The corners of a triangle relative to the end of a contact zone.
struct Corners {
  Vector of[3];
  double lowest = 0, far = 0;  ///< on the minus side; the largest distance

  Corners(const CutMesh& cut, std::size_t t, const ContactEnd& end) {
    for (std::size_t i = 0; i < 3; ++i) {
      of[i] = between(end.place, cut.at[at(cut.copy[3 * t + i])]);
      lowest = std::min(lowest, dot(of[i], end.normal));
      far = std::max(far, size_of(of[i]));
    }
  }
  /// Whether a part of the triangle lies there.
  bool on_minus_side() const { return lowest < -rounding * far; }
  double near() const {
    return std::min({distance(of[0], of[1]), distance(of[1], of[2]), distance(of[2], of[0])});
  }
};

class Ends {
 public:
  Ends(const CutMesh& cut, const EquilibratedFlux& sigma, std::span<const double> oscillation,
       double most_unbalanced)
      : _cut(cut), _sigma(sigma), _oscillation(oscillation), _most_unbalanced(most_unbalanced) {
    double largest = 0;
    for (std::size_t f = 0; f < cut.faces.size(); ++f)
      for (const std::size_t end : {0, 1})
        if (presses(cut.faces[f].condition)) largest = std::max(largest, sigma.jump(f, end));
    _least_jump = 1e-12 * largest;
  }

  std::vector<ContactEnd> operator()() const {
    std::vector<ContactEnd> ends;
    // A node at which one minus face is closed and another one is open.
    std::map<std::pair<std::int32_t, Vector>, std::array<std::int64_t, 2>> at_node;
    for (std::size_t f = 0; f < _cut.faces.size(); ++f) {
      stop::look_at_turn(f, weighing);
      const Face& face = _cut.faces[f];
      if (face.condition != Condition::pressed || _cut.tilts[at(face.inclusion)] != 0) continue;
      for (const std::size_t end : {0, 1})
        if (!opens(f, end))
          at_node
              .try_emplace({face.inclusion, places(_cut, f)[end]},
                           std::array<std::int64_t, 2>{-1, -1})
              .first->second[opens(f, 1 - end) ? 1 : 0] = static_cast<std::int64_t>(f);
    }
    for (const auto& [node, faces] : at_node) {
      if (faces[0] < 0 || faces[1] < 0) continue;
      if (ends.size() == most_ends) return {};
      ends.push_back(end_at(node.second, static_cast<std::size_t>(faces[0]),
                            static_cast<std::size_t>(faces[1])));
    }
    for (ContactEnd& end : ends) find_reach(end, ends);
    std::erase_if(ends, [](const ContactEnd& end) { return !(end.reach > 0); });
    return ends;
  }

 private:
  static constexpr std::size_t most_ends = 8;  // each looks at every face

  bool opens(std::size_t face, std::size_t end) const {
    return _sigma.jump(face, end) > _least_jump;
  }

  ContactEnd end_at(const Vector& place, std::size_t closed, std::size_t open) const {
    ContactEnd end;
    end.face = open;
    end.place = place;
    const auto ends = _cut.ends(_cut.faces[open]);
    end.open = _cut.at[at(ends[0])] == place ? ends[1] : ends[0];
    const auto [a, b] = places(_cut, closed);
    const Vector edge = a == place ? between(a, b) : between(b, a);
    const Vector normal = normal_of(a, b);
    const double size = size_of(edge);
    end.along = {edge[0] / size, edge[1] / size};
    end.normal = {normal[0] / size, normal[1] / size};
    const auto [c, d] = places(_cut, open);
    end.length = std::max(size, size_of(between(c, d)));
    return end;
  }

  /// The largest R: below the distance from everything that the half disc may not meet, and half
  /// that from other ends, whose discs are others.
  void find_reach(ContactEnd& end, const std::vector<ContactEnd>& ends) const {
    constexpr double part = 0.95;
    const std::vector<Stretch> closed = line_from(_cut, end, 1), open = line_from(_cut, end, -1);
    if (closed.empty() || open.empty()) return;
    double most = std::min(closed.back().to, open.back().to);
    for (const ContactEnd& other : ends)
      if (&other != &end) most = std::min(most, 0.5 * size_of(between(end.place, other.place)));
    for (std::size_t f = 0; f < _cut.faces.size(); ++f) {
      stop::look_at_turn(f, weighing);
      const auto [a, b] = places(_cut, f);
      const Vector p = between(end.place, a), q = between(end.place, b);
      const double size = std::max(size_of(p), size_of(q));
      if (std::min(dot(p, end.normal), dot(q, end.normal)) < -rounding * size)
        most = std::min(most, distance(p, q));
    }
    most = std::min(most, balanced_within(end, most));
    for (const Stretch& one : closed) {
      const bool holds =
          !opens(one.face, 0) && !opens(one.face, 1) && pressure_of(_sigma, one.face).sum() > 0;
      if (!holds || one.to > part * most) break;
      end.reach = one.to;
    }
    if (!one_tension(end)) end.reach = 0;
  }

  /// The radius at which the half disc, of at most `most`, has too much load that is not balanced.
  double balanced_within(const ContactEnd& end, double most) const {
    std::vector<std::pair<double, double>> squares;  // of o, by the distance from the end
    for (std::size_t t = 0; t < _oscillation.size(); ++t) {
      stop::look_at_turn<stop::quick>(t, weighing);
      if (_oscillation[t] == 0) continue;
      const Corners corners(_cut, t, end);
      if (!corners.on_minus_side()) continue;
      if (const double near = corners.near(); near < most)
        squares.emplace_back(near, _oscillation[t] * _oscillation[t]);
    }
    std::ranges::sort(squares);
    double sum = 0;
    for (const auto& [near, square] : squares)
      if ((sum += square) > _most_unbalanced * _most_unbalanced) return near;
    return most;
  }

  /// Whether T is one number in the half disc.
  bool one_tension(const ContactEnd& end) const {
    const Shapes& shapes = _cut.shapes;
    double tension = -1;
    for (std::size_t t = 0; t < _cut.triangle_count(); ++t) {
      stop::look_at_turn<stop::quick>(t, weighing);
      const Corners corners(_cut, t, end);
      if (!corners.on_minus_side() || corners.near() > end.reach) continue;
      if (tension < 0) tension = shapes.tension[t];
      if (shapes.tension[t] != tension) return false;
      // A matrix T is mapped to a number, and so are the sides.
      const Vector side = shapes.side(3 * t), own = between(corners.of[1], corners.of[2]);
      if (size_of(between(own, side)) > rounding * size_of(own)) return false;
    }
    return true;
  }

  const CutMesh& _cut;
  const EquilibratedFlux& _sigma;
  std::span<const double> _oscillation;
  const double _most_unbalanced;
  double _least_jump = 0;
};

/// w about one end.
class Weighing {
 public:
  Weighing(const CutMesh& cut, const EquilibratedFlux& sigma, const ContactEnd& end, double inner,
           double beta)
      : _cut(cut),
        _sigma(sigma),
        _end(end),
        _beta(beta),
        _closed(line_from(cut, end, 1)),
        _open(line_from(cut, end, -1)) {
    const double least = std::max(inner * end.reach, 3 * end.length);
    for (const Stretch& one : _closed) {  // l lies in a node of the closed zone
      _l = one.to;
      if (_l >= least) break;
    }
  }

  /// Adds the weight; returns false if there is none.
  bool add_to(Weight& sum) const {
    if (!(_l <= 0.5 * _end.reach)) return false;
    const std::size_t before = sum.faces.size();
    if (!add_faces(sum)) {
      sum.faces.resize(before);
      return false;
    }
    add_triangles(sum);
    sum.largest = std::max(sum.largest, w(0));
    return true;
  }

 private:
  double w(double s) const { return std::pow(_end.reach / std::clamp(s, _l, _end.reach), _beta); }

  bool add_faces(Weight& sum) const {
    double closed_force = 0, open_force = 0;  // p of whole faces passed so far
    auto open = _open.begin();
    for (const Stretch& one : _open) {
      if (one.from >= _end.reach) break;
      const Pressure p = pressure_of(_sigma, one.face);
      sum.faces.push_back(
          {one.face, w(one.from), w(one.to), {w(one.to) * p.part[0], w(one.to) * p.part[1]}});
    }
    for (const Stretch& one : _closed) {
      if (one.from >= _end.reach) break;
      const Pressure p = pressure_of(_sigma, one.face);
      const double length = one.to - one.from;
      closed_force += p.sum();
      // All of a face that begins within one.to of the end: more than P.
      for (; open != _open.end() && open->from < one.to; ++open)
        open_force += pressure_of(_sigma, open->face).sum();
      double part = w(one.to);
      if (one.to > _l * (1 + rounding)) {
        const double slope = _beta * w(one.from) / one.from;
        part -= slope * (closed_force + open_force) * length / p.sum();
      }
      if (!(part > 0)) return false;
      sum.faces.push_back({one.face, w(one.from), w(one.to), {part * p.part[0], part * p.part[1]}});
    }
    return true;
  }

  void add_triangles(Weight& sum) const {
    for (std::size_t t = 0; t < _cut.triangle_count(); ++t) {
      stop::look_at_turn<stop::quick>(t, weighing);
      const Corners corners(_cut, t, _end);
      if (!corners.on_minus_side()) continue;
      const double near = corners.near();
      if (near < _end.reach)
        sum.triangles.push_back({t, w(near), w(corners.far), corners.far > _l});
    }
  }

  const CutMesh& _cut;
  const EquilibratedFlux& _sigma;
  const ContactEnd& _end;
  double _beta, _l = 0;
  std::vector<Stretch> _closed, _open;
};

}  // namespace

WeightOf::WeightOf(const EquilibratedFlux& sigma, const Weight* weight) : _sigma(sigma) {
  if (weight != nullptr) _faces = weight->faces;
}

Weight::OnFace WeightOf::on(std::size_t face) {
  while (!_faces.empty() && _faces.front().face < face) _faces = _faces.subspan(1);
  if (!_faces.empty() && _faces.front().face == face) return _faces.front();
  const Pressure p = pressure_of(_sigma, face);
  return {face, 1, 1, {p.part[0], p.part[1]}};
}

std::vector<ContactEnd> contact_ends(const CutMesh& cut, const EquilibratedFlux& sigma,
                                     std::span<const double> oscillation, double most_unbalanced) {
  if (!cut.shapes.variation.empty()) return {};
  return Ends(cut, sigma, oscillation, most_unbalanced)();
}

Weight weight_about(const CutMesh& cut, const EquilibratedFlux& sigma,
                    const std::vector<ContactEnd>& ends, double inner, double beta) {
  Weight sum;
  sum.beta = beta;
  for (const ContactEnd& end : ends) Weighing(cut, sigma, end, inner, beta).add_to(sum);
  std::ranges::sort(sum.triangles, {}, &Weight::OnTriangle::triangle);
  std::ranges::sort(sum.faces, {}, &Weight::OnFace::face);
  return sum;
}

}  // namespace anticrack::estimate
