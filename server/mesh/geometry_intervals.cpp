// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry_steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <string>
#include <utility>

#include "base/at.hpp"
#include "mesh/geometry_primitives.hpp"

namespace anticrack::mesh {
namespace {

constexpr int paper_intervals = 80;

void share(const Plan& plan, const std::vector<PlannedCurve*>& curves) {
  if (curves.empty()) return;
  std::vector<double> lengths;
  lengths.reserve(curves.size());
  for (const PlannedCurve* curve : curves) lengths.push_back(length_of(plan, *curve));
  const std::vector<int> shares = apportion(lengths, paper_intervals);
  for (std::size_t i = 0; i < curves.size(); ++i) curves[i]->intervals = shares[i];
}

/// An edge is at most this many times as long as the distance to what is near it.
constexpr double ratio = 2;

/// A point near which edges must be no longer than `size`.
struct Fine {
  Point at{};
  double size = 0;
};

Segment segment_of(const Plan& plan, const PlannedCurve& curve) {
  return {plan.points[at(curve.a)], plan.points[at(curve.b)]};
}

bool joined(const PlannedCurve& s, const PlannedCurve& t) {
  return s.a == t.a || s.a == t.b || s.b == t.a || s.b == t.b;
}

/// The ends of curves shorter than `size`, by x.
std::vector<Fine> fine_points(const Plan& plan, double size) {
  std::vector<double> least(plan.points.size(), size);
  for (const PlannedCurve& curve : plan.curves) {
    for (const int end : {curve.a, curve.b}) {
      double& own = least[at(end)];
      own = std::min(own, ratio * length_of(plan, curve));
    }
  }
  std::vector<Fine> fine;
  for (std::size_t i = 0; i < least.size(); ++i)
    if (least[i] < size) fine.push_back({plan.points[i], least[i]});
  std::sort(fine.begin(), fine.end(), [](const Fine& a, const Fine& b) { return a.at < b.at; });
  return fine;
}

/// For each curve, the curves without a common point that are near it and for which it is too long.
std::vector<std::vector<int>> near_curves(const Plan& plan, double size) {
  std::vector<Segment> segments;
  segments.reserve(plan.curves.size());
  for (const PlannedCurve& curve : plan.curves) segments.push_back(segment_of(plan, curve));
  const double reach = size / ratio;
  std::vector<std::vector<int>> near(plan.curves.size());
  each_near_pair(segments, reach, [&](std::size_t s, std::size_t t) {
    if (joined(plan.curves[s], plan.curves[t])) return;
    const double longest =
        std::max(length_of(plan, plan.curves[s]), length_of(plan, plan.curves[t]));
    if (!boxes_meet(segments[s], segments[t], longest / ratio)) return;
    const double limit = ratio * distance(segments[s], segments[t]);
    if (limit >= size) return;
    if (limit < length_of(plan, plan.curves[s])) near[s].push_back(static_cast<int>(t));
    if (limit < length_of(plan, plan.curves[t])) near[t].push_back(static_cast<int>(s));
  });
  return near;
}

class Cutter {
 public:
  Cutter(const Plan& plan, double size, double growth, std::size_t max_curves)
      : _plan(plan),
        _size(size),
        _growth(growth),
        _max_curves(max_curves),
        _fine(fine_points(plan, size)),
        _near(near_curves(plan, size)) {
    for (const Fine& fine : _fine) _least = std::min(_least, fine.size);
  }

  /// The places in (0,1) where the curve is to be cut, in order.
  std::vector<double> cuts(std::size_t curve) {
    _cuts.clear();
    const Segment whole = segment_of(_plan, _plan.curves[curve]);
    std::vector<Fine> fine;
    if (distance(whole.a, whole.b) > _least) {
      const double reach = _size / _growth;
      const auto first =
          std::lower_bound(_fine.begin(), _fine.end(), std::min(whole.a[0], whole.b[0]) - reach,
                           [](const Fine& f, double x) { return f.at[0] < x; });
      for (auto f = first; f != _fine.end(); ++f) {
        if (f->at[0] > std::max(whole.a[0], whole.b[0]) + reach) break;
        if (allowed(*f, whole) < _size) fine.push_back(*f);
      }
    }
    cut(whole, 0, 1, fine, _near[curve]);
    return _cuts;
  }

 private:
  double allowed(const Fine& fine, const Segment& piece) const {
    return fine.size + _growth * distance(fine.at, piece);
  }

  /// Halves the stretch until nothing near it requires shorter edges.
  void cut(const Segment& whole, double from, double to, const std::vector<Fine>& fine,
           const std::vector<int>& near) {
    const Segment piece{point_on(whole, from), point_on(whole, to)};
    const double length = distance(piece.a, piece.b);
    const double wanted = std::min(length, _size);
    std::vector<Fine> still_fine;
    for (const Fine& f : fine)
      if (allowed(f, piece) < wanted) still_fine.push_back(f);
    std::vector<int> still_near;
    for (const int t : near) {
      const Segment other = segment_of(_plan, _plan.curves[at(t)]);
      if (ratio * distance(piece, other) < wanted) still_near.push_back(t);
    }
    if (still_fine.empty() && still_near.empty()) return;
    if (++_count > _max_curves) {
      throw errors::Error(errors::Reason::limit_exceeded,
                          "the lines come so near to one another over such a length, at {}, that "
                          "more than {} edges are needed there; move them apart or join them",
                          shown(piece.a), _max_curves)
          .at("interfaces");
    }
    const double middle = (from + to) / 2;
    cut(whole, from, middle, still_fine, still_near);
    _cuts.push_back(middle);
    cut(whole, middle, to, still_fine, still_near);
  }

  const Plan& _plan;
  double _size;
  double _growth;
  std::size_t _max_curves;
  std::size_t _count = 0;
  double _least = 1e300;
  std::vector<Fine> _fine;
  std::vector<std::vector<int>> _near;
  std::vector<double> _cuts;
};

/// gmsh takes as long for a curve as for a few hundred triangles, so this many equal pieces in a
/// row become intervals of one curve.
constexpr std::size_t least_row = 32;

/// How many pieces from cut `i` on become one curve; the first begins at `from`. Lengths are powers
/// of two.
std::size_t equal_pieces(const std::vector<double>& cuts, std::size_t i, double from) {
  const double length = cuts[i] - from;
  std::size_t count = 1;
  while (i + count < cuts.size() && cuts[i + count] - cuts[i + count - 1] == length) ++count;
  return count < least_row ? 1 : count;
}

}  // namespace

double length_of(const Plan& plan, const PlannedCurve& curve) noexcept {
  return distance(plan.points[at(curve.a)], plan.points[at(curve.b)]);
}

void set_paper_intervals(Plan& plan) {
  std::vector<PlannedCurve*> glue;
  std::vector<PlannedCurve*> rest;
  std::array<std::vector<PlannedCurve*>, 2> outer;
  for (PlannedCurve& curve : plan.curves)
    if (curve.role == Role::interface)
      (curve.kind == Kind::glue ? glue : rest).push_back(&curve);
    else
      outer[at(curve.left)].push_back(&curve);
  share(plan, glue);
  share(plan, rest);
  for (const auto& curves : outer) share(plan, curves);
}

void set_intervals(Plan& plan, double size) {
  for (PlannedCurve& curve : plan.curves) {
    if (curve.bend >= 0) continue;  // a chord, which is short enough
    // a length that is, up to rounding, a whole number of sizes is cut into just as many pieces
    const double piece = length_of(plan, curve) / curve.intervals;
    curve.intervals *= static_cast<int>(std::max(1.0, std::ceil(piece / size - 1e-9)));
  }
}

std::vector<int> apportion(std::span<const double> lengths, int total) {
  const std::size_t k = lengths.size();
  const double sum = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  std::vector<int> shares(k, 1);
  std::vector<double> owed(k, 0.0);  // by how much a curve's quota exceeds its share
  int left = total;
  for (std::size_t i = 0; i < k; ++i) {
    const double quota = total * (lengths[i] / sum);
    // a quota that is a whole number up to rounding counts as this number
    shares[i] = std::max(1, static_cast<int>(std::floor(quota + 1e-9)));
    owed[i] = quota - shares[i];
    left -= shares[i];
  }
  std::vector<std::size_t> order(k);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return owed[a] > owed[b] + 1e-9; });
  for (std::size_t i = 0; left > 0; i = (i + 1) % k, --left) ++shares[order[i]];
  // the intervals of curves raised to one are taken from the curves that are most above their quota
  while (left < 0) {
    std::size_t richest = k;
    for (std::size_t i = 0; i < k; ++i) {
      if (shares[i] < 2) continue;
      const auto above = [&](std::size_t j) { return shares[j] - total * (lengths[j] / sum); };
      if (richest == k || above(i) > above(richest) + 1e-9) richest = i;
    }
    if (richest == k) break;
    --shares[richest];
    ++left;
  }
  return shares;
}

void cut_near(Plan& plan, double size, double growth, std::size_t max_curves) {
  Cutter cutter(plan, size, growth, max_curves);
  std::vector<std::vector<double>> cuts;
  cuts.reserve(plan.curves.size());
  for (std::size_t e = 0; e < plan.curves.size(); ++e) cuts.push_back(cutter.cuts(e));
  std::vector<std::vector<int>> pieces(plan.curves.size());
  std::vector<PlannedCurve> curves;
  curves.reserve(plan.curves.size());
  for (std::size_t e = 0; e < cuts.size(); ++e) {
    PlannedCurve piece = plan.curves[e];
    const Segment whole = segment_of(plan, piece);
    const int last = piece.b;
    const double first = piece.from, turn = piece.to - piece.from;
    if (!cuts[e].empty()) piece.chord = length_of(plan, piece);
    const auto add = [&](int b, double to, int intervals) {
      piece.b = b;
      piece.to = first + to * turn;
      piece.intervals = intervals;
      pieces[e].push_back(static_cast<int>(curves.size()));
      curves.push_back(piece);
      piece.a = b;
      piece.from = piece.to;
    };
    cuts[e].push_back(1);
    double from = 0;
    for (std::size_t i = 0; i < cuts[e].size();) {
      const std::size_t count = equal_pieces(cuts[e], i, from);
      i += count;
      from = cuts[e][i - 1];
      if (i < cuts[e].size()) plan.points.push_back(point_on(whole, from));
      add(i < cuts[e].size() ? static_cast<int>(plan.points.size()) - 1 : last, from,
          static_cast<int>(count));
    }
  }
  replace_curves(plan, std::move(curves), pieces);
}

void replace_curves(Plan& plan, std::vector<PlannedCurve> curves,
                    const std::vector<std::vector<int>>& pieces) {
  const auto replace = [&](std::vector<int>& list) {
    std::vector<int> now;
    for (const int curve : list)
      now.insert(now.end(), pieces[at(curve)].begin(), pieces[at(curve)].end());
    list = std::move(now);
  };
  const auto replace_loop = [&](std::vector<int>& loop) {
    std::vector<int> now;
    for (const int edge : loop) {
      const std::vector<int>& own = pieces[at(std::abs(edge) - 1)];
      const auto first = static_cast<std::ptrdiff_t>(now.size());
      for (const int piece : own) now.push_back(edge > 0 ? piece + 1 : -piece - 1);
      if (edge < 0) std::reverse(now.begin() + first, now.end());
    }
    loop = std::move(now);
  };
  plan.curves = std::move(curves);
  for (PlannedInterface& interface : plan.interfaces) replace(interface.curves);
  for (PlannedFace& face : plan.faces) {
    replace_loop(face.outer);
    for (auto& hole : face.holes) replace_loop(hole);
    replace(face.embedded);
  }
}

}  // namespace anticrack::mesh
