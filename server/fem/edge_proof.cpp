// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/edge_proof.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

#include "base/at.hpp"
#include "stop/stop.hpp"

namespace anticrack::fem {
namespace {

using expression::Enclosure;
using expression::Interval;
using expression::Jet;

constexpr double unbounded = std::numeric_limits<double>::infinity();
/// Bound of the unknown part of all edges, relative to int |g|, at which halving ends.
constexpr double enough = 1e-8;
constexpr int finest = 48;

Interval along(double middle, double d) {
  return {middle - 0.5 * std::abs(d), middle + 0.5 * std::abs(d)};
}

/// A part of an edge.
struct Half {
  std::size_t edge;
  double from, to;
  int depth;
  EnclosedPiece found;
  double length;
  bool divided = false;
};

}  // namespace

EnclosedPiece enclose(Enclosure& g, const Piece& piece) {
  const double x = piece.x, y = piece.y, dx = piece.dx, dy = piece.dy;
  const Jet jet = g(along(x, dx), along(y, dy), 3);
  EnclosedPiece result;
  result.values = jet.value();
  result.middle = result.mean = jet.value().middle();
  result.radius = result.deviation = jet.value().finite() ? jet.value().radius() : unbounded;
  result.slope = expression::everything;
  if (jet.order < 1) return result;
  const Jet centre = g({x, x}, {y, y}, jet.order - 1);
  const auto& c = jet.of;
  const double value = centre.value().middle(), off = centre.value().radius();
  result.slope = dx * c[1] + dy * c[2];
  const double steep = result.slope.magnitude();
  if (!std::isfinite(steep)) return result;
  result.values = {std::max(result.values.low, value - off - 0.5 * steep),
                   std::min(result.values.high, value + off + 0.5 * steep)};
  result.middle = value;
  result.deviation = off + steep * std::sqrt(1.0 / 12);
  const auto keep = [&](double mean, double radius) {
    if (!(radius < result.radius)) return;
    result.mean = mean;
    result.radius = radius;
  };
  keep(value, off + 0.25 * result.slope.radius());
  const auto second = [&](const Jet& by) {
    return dx * dx * by.of[3] + dx * dy * by.of[4] + dy * dy * by.of[5];
  };
  if (jet.order >= 2) keep(value + second(jet).middle() / 12, off + second(jet).radius() / 12);
  if (jet.order >= 3) {
    const Interval third =
        dx * dx * dx * c[6] + dx * dx * dy * c[7] + dx * dy * dy * c[8] + dy * dy * dy * c[9];
    keep(value + second(centre).middle() / 12,
         off + second(centre).radius() / 12 + third.radius() / 32);
  }
  return result;
}

namespace {

class EdgeProver {
 public:
  EdgeProver(const Triangulation& part, std::span<const std::array<std::int32_t, 2>> edges,
             const expression::Function& g, TractionParts& parts, std::span<double> load,
             double work)
      : _part(part), _edges(edges), _enclosure(g.tape()), _parts(parts), _load(load), _work(work) {}

  Proof operator()() {
    for (std::size_t e = 0; e < _edges.size(); ++e) add({e, 0, 1, 0, {}, 0});
    while (!_queue.empty() && _work > 0 && !enough_is_known()) {
      stop::look("integrating a load");
      const std::size_t i = _queue.top().second;
      _queue.pop();
      divide(i);
    }
    conclude();
    bound_rest();
    return _proof;
  }

 private:
  /// The bounds of some pieces together.
  struct Known {
    double unknown = 0, absolute = 0;
    std::size_t without = 0;  ///< pieces of which nothing is known
    void count(const Half& one, int sign) {
      const double radius = one.length * one.found.radius;
      if (std::isfinite(radius)) {
        unknown += sign * radius;
        absolute += sign * one.length * std::abs(one.found.mean);
      } else {
        without = sign > 0 ? without + 1 : without - 1;
      }
    }
    bool suffices() const { return without == 0 && unknown <= enough * absolute; }
  };

  const double* point(std::int32_t node) const { return &_part.xy[2 * at(node)]; }
  double length(std::size_t edge) const {
    const double *p = point(_edges[edge][0]), *q = point(_edges[edge][1]);
    return std::hypot(q[0] - p[0], q[1] - p[1]);
  }

  void add(Half one) {
    const double *p = point(_edges[one.edge][0]), *q = point(_edges[one.edge][1]);
    const double dx = q[0] - p[0], dy = q[1] - p[1], middle = 0.5 * (one.from + one.to),
                 share = one.to - one.from;
    one.found =
        enclose(_enclosure, {p[0] + middle * dx, p[1] + middle * dy, share * dx, share * dy});
    one.length = share * std::hypot(dx, dy);
    _work -= 3 * _enclosure.cost();
    _known.count(one, 1);
    const double radius = one.length * one.found.radius;
    const double resolved = 1e-13 * (std::abs(p[0]) + std::abs(p[1]));
    if (radius > 0 && one.depth < finest && one.length > resolved)
      _queue.emplace(radius, _halves.size());
    _halves.push_back(one);
  }

  void divide(std::size_t i) {
    const Half one = _halves[i];
    const double middle = 0.5 * (one.from + one.to);
    _known.count(one, -1);
    _halves[i].divided = true;
    add({one.edge, one.from, middle, one.depth + 1, {}, 0});
    add({one.edge, middle, one.to, one.depth + 1, {}, 0});
  }

  template <class Function>
  void each_piece(const Function& function) const {
    for (const Half& one : _halves)
      if (!one.divided) function(one);
  }

  bool enough_is_known() {
    if (!_known.suffices()) return false;
    _known = {};  // large terms that were subtracted have left their rounding
    each_piece([&](const Half& one) { _known.count(one, 1); });
    return _known.suffices();
  }

  void conclude() {
    struct Sum {
      double integral = 0, radius = 0, at_second = 0;
    };
    std::vector<Sum> sums(_edges.size());
    each_piece([&](const Half& one) {
      Sum& sum = sums[one.edge];
      sum.integral += one.length * one.found.mean;
      sum.at_second += one.length * one.found.mean * 0.5 * (one.from + one.to);
      sum.radius += one.length * one.found.radius;
      _proof.absolute += one.length * std::abs(one.found.mean);
    });
    _parts.unknown.assign(_edges.size(), 0);
    double most = 0;
    for (std::size_t e = 0; e < _edges.size(); ++e) {
      const Sum& sum = sums[e];
      const double* own = &_parts.load[2 * e];
      const double slack = sum.radius + 1e-14 * std::abs(sum.integral);
      const double doubt =
          1e-9 * (std::abs(sum.integral) + _known.absolute / static_cast<double>(_edges.size()));
      if (std::abs(own[0] + own[1] - sum.integral) > slack + doubt)  // the samples missed something
        replace(e, {sum.integral - sum.at_second, sum.at_second});
      _parts.unknown[e] = std::abs(own[0] + own[1] - sum.integral) + slack;
      _proof.unknown += _parts.unknown[e];
      if (!(_parts.unknown[e] > most)) continue;
      most = _parts.unknown[e];
      const double *p = point(_edges[e][0]), *q = point(_edges[e][1]);
      _proof.worst_x = 0.5 * (p[0] + q[0]);
      _proof.worst_y = 0.5 * (p[1] + q[1]);
    }
  }

  void replace(std::size_t edge, const std::array<double, 2>& moments) {
    for (std::size_t k = 0; k < 2; ++k) {
      double& own = _parts.load[2 * edge + k];
      _load[at(_edges[edge][k])] += moments[k] - own;
      own = moments[k];
    }
  }

  /// Bounds g - g_h.
  void bound_rest() {
    _parts.beyond.assign(_edges.size(), 0);
    each_piece([&](const Half& one) {
      const double* own = &_parts.load[2 * one.edge];
      const double mean = (own[0] + own[1]) / length(one.edge);
      const double off = std::abs(one.found.middle - mean) + one.found.deviation;
      _parts.beyond[one.edge] += one.length * off * off;
    });
    for (std::size_t e = 0; e < _edges.size(); ++e)
      _parts.beyond[e] = std::sqrt(_parts.beyond[e]) + 4 * _parts.unknown[e] / std::sqrt(length(e));
  }

  const Triangulation& _part;
  std::span<const std::array<std::int32_t, 2>> _edges;
  Enclosure _enclosure;
  TractionParts& _parts;
  std::span<double> _load;
  double _work;
  std::vector<Half> _halves;
  std::priority_queue<std::pair<double, std::size_t>> _queue;
  Known _known;
  Proof _proof;
};

}  // namespace

Proof prove_traction(const Triangulation& part, std::span<const std::array<std::int32_t, 2>> edges,
                     const expression::Function& g, TractionParts& parts, std::span<double> load,
                     double work) {
  return EdgeProver(part, edges, g, parts, load, work)();
}

}  // namespace anticrack::fem
