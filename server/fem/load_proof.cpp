// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/load_proof.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>

#include "base/at.hpp"
#include "fem/cell.hpp"
#include "fem/cell_enclosure.hpp"
#include "fem/sampler.hpp"
#include "stop/stop.hpp"

namespace anticrack::fem {
namespace {

using expression::Enclosure;
using expression::Jet;

constexpr double infinite = std::numeric_limits<double>::infinity();
/// Boxes with at most this many triangles are not divided; each triangle is looked at instead.
constexpr std::size_t few = 12;
constexpr std::int32_t deepest = 48;
/// Relative rounding error of a sum of some terms.
constexpr double rounding = 1e-14;

Centred centred(const Frame& frame, const Cell& cell) {
  std::array<double, 3> x{}, y{};
  for (std::size_t i = 0; i < 3; ++i) {
    x[i] = frame.at_x(cell.corners[i]);
    y[i] = frame.at_y(cell.corners[i]);
  }
  return {x, y};
}

/// f_h on a triangle, from its moments.
struct Linear {
  std::array<double, 3> corner;
  Linear(const double* moments, double area) {
    const double sum = moments[0] + moments[1] + moments[2];
    for (std::size_t i = 0; i < 3; ++i) corner[i] = (12 * moments[i] - 3 * sum) / area;
  }
  double operator()(const Place& p) const {
    return (1 - p.b - p.c) * corner[0] + p.b * corner[1] + p.c * corner[2];
  }
};

/// A part of a triangle that is quartered.
struct Quarter {
  Cell cell;
  Enclosed found;
  double area = 0;
  std::int32_t children = -1;  ///< the first of four
};

class ForceProver {
 public:
  ForceProver(std::span<const double> xy, std::span<const std::int32_t> triangles,
              const expression::Function& f, ForceParts& parts, std::span<double> load,
              const ProofOptions& options)
      : _xy(xy),
        _triangles(triangles),
        _enclosure(f.tape()),
        _parts(parts),
        _load(load),
        _options(options),
        _work(options.work),
        _order(triangles.size() / 3) {}

  Proof operator()() {
    const std::size_t count = _order.size();
    _parts.beyond.assign(count, 0);
    _parts.unknown.assign(count, 0);
    _parts.moments.assign(count, 0);
    if (_options.spread != nullptr) _options.spread->assign(count, {});
    std::iota(_order.begin(), _order.end(), 0);
    _proof.absolute = _options.absolute;
    _area = _options.area;
    if (_area > 0) enclose_boxes();
    quarter();
    for (std::size_t t = 0; t < count; ++t) {
      _proof.unknown += _parts.unknown[t];
      if (!(_parts.unknown[t] > _most_unknown)) continue;
      _most_unknown = _parts.unknown[t];
      const Centred middle = centred(frame_of(_xy, _triangles, t), {});
      _proof.worst_x = middle.x;
      _proof.worst_y = middle.y;
    }
    return _proof;
  }

 private:
  struct Range {
    std::size_t begin, end;
  };
  struct Box {
    Interval x{infinite, -infinite}, y{infinite, -infinite};
    double length_x = 0, length_y = 0;  ///< the greatest of its triangles
    void add(double px, double py) {
      x = {std::min(x.low, px), std::max(x.high, px)};
      y = {std::min(y.low, py), std::max(y.high, py)};
    }
  };

  Centred whole(std::size_t t) const { return centred(frame_of(_xy, _triangles, t), {}); }

  void enclose_boxes() {
    std::vector<Range> ranges{{0, _order.size()}};
    while (!ranges.empty()) {
      stop::look("integrating a load");
      const Range range = ranges.back();
      ranges.pop_back();
      const std::span<std::int32_t> own(&_order[range.begin], range.end - range.begin);
      const Box box = box_of(own);
      const Jet jet = enclose_box(box);
      if (suffices(jet, box)) {
        std::size_t turn = 0;
        for (const std::int32_t t : own) {
          stop::look_at_turn(++turn, "integrating a load");
          _options.curved.empty() || _options.curved[at(t)] == 0 ? settle(at(t), jet) : keep(at(t));
        }
      } else if (own.size() <= few) {
        for (const std::int32_t t : own) enclose_alone(at(t));
      } else {
        const std::size_t middle = range.begin + divide(own, box);
        ranges.push_back({middle, range.end});
        ranges.push_back({range.begin, middle});
      }
    }
  }

  Jet enclose_box(const Box& box) {
    spend(1);
    return _enclosure(box.x, box.y, Jet::most);
  }
  void spend(std::size_t boxes) {
    _proof.boxes += boxes;
    _work -= static_cast<double>(boxes) * _enclosure.cost();
  }

  Box box_of(std::span<const std::int32_t> own) const {
    Box box;
    std::size_t turn = 0;
    for (const std::int32_t t : own) {
      stop::look_at_turn<stop::quick>(++turn, "integrating a load");
      const Frame f = frame_of(_xy, _triangles, at(t));
      box.add(f.x, f.y);
      box.add(f.x + f.bx, f.y + f.by);
      box.add(f.x + f.cx, f.y + f.cy);
      box.length_x = std::max(box.length_x, squared_x(f));
      box.length_y = std::max(box.length_y, squared_y(f));
    }
    box.length_x = std::sqrt(box.length_x);
    box.length_y = std::sqrt(box.length_y);
    return box;
  }

  // The sum of dx^2 about the centroid over the root of 60: the square of Centred::length_x.
  static constexpr double two_thirds_over_root_of_60 = 0.08606629658238704;
  static double squared_x(const Frame& f) {
    return two_thirds_over_root_of_60 * (f.bx * f.bx + f.cx * f.cx - f.bx * f.cx);
  }
  static double squared_y(const Frame& f) {
    return two_thirds_over_root_of_60 * (f.by * f.by + f.cy * f.cy - f.by * f.cy);
  }
  static std::array<double, 2> lengths(const Frame& f) {
    return {std::sqrt(squared_x(f)), std::sqrt(squared_y(f))};
  }

  /// Separates the triangles at the middle of the box; returns how many are on the first side.
  std::size_t divide(std::span<std::int32_t> own, const Box& box) const {
    const bool wide = box.x.high - box.x.low > box.y.high - box.y.low;
    const double middle = 3 * (wide ? box.x : box.y).middle();
    const auto first = [&](std::int32_t t) {
      const Frame f = frame_of(_xy, _triangles, at(t));
      return (wide ? 3 * f.x + f.bx + f.cx : 3 * f.y + f.by + f.cy) < middle;
    };
    const auto found =
        static_cast<std::size_t>(std::partition(own.begin(), own.end(), first) - own.begin());
    return found == 0 || found == own.size() ? own.size() / 2 : found;
  }

  double mean() const { return _proof.absolute / _area; }

  /// Greatest error of the integral over a triangle of these lengths, divided by its area. Rules
  /// have positive weights and integrate exactly the function of degree 4 that has the midpoints of
  /// the fourth derivatives.
  double miss(const Jet& jet, double u, double v) const {
    const auto& c = jet.of;
    if (_options.exact) return 0;
    if (_options.interpolated) {  // reach <= 2.3 length
      return 2 * 2.3 * 2.3 *
             (c[3].magnitude() * u * u + c[4].magnitude() * u * v + c[5].magnitude() * v * v);
    }
    return 2 * (c[10].radius() * u * u * u * u + c[11].radius() * u * u * u * v +
                c[12].radius() * u * u * v * v + c[13].radius() * u * v * v * v +
                c[14].radius() * v * v * v * v);
  }
  static double bend(const Jet& jet, double u, double v) {
    return jet.of[3].magnitude() * u * u + jet.of[4].magnitude() * u * v +
           jet.of[5].magnitude() * v * v;
  }
  static double vary(const Jet& jet, double u, double v) {
    return jet.of[3].radius() * u * u + jet.of[4].radius() * u * v + jet.of[5].radius() * v * v;
  }
  static double slope(const Jet& jet, double x, double y) {
    return jet.of[1].magnitude() * x + jet.of[2].magnitude() * y;
  }

  bool known(const Jet& jet, double u, double v) const {
    return jet.order == Jet::most && miss(jet, u, v) <= _options.tolerance * mean() &&
           std::isfinite(bend(jet, u, v));
  }

  /// Whether the bounds from a box are about as good as those from each of its triangles.
  bool suffices(const Jet& jet, const Box& box) const {
    const double u = box.length_x, v = box.length_y, all = bend(jet, u, v);
    if (!known(jet, u, v)) return false;
    if (_options.spread != nullptr) {
      const double first = slope(jet, u, v),
                   change = jet.of[1].radius() * u + jet.of[2].radius() * v;
      if (first > 3e-3 * mean() && change > 0.3 * first) return false;
    }
    constexpr double little = 5e-3;
    return all <= little * mean() || vary(jet, u, v) <= 0.5 * all;
  }

  void settle(std::size_t t, const Jet& jet) {
    const Frame frame = frame_of(_xy, _triangles, t);
    if (!(frame.area > 0)) return;
    const auto [u, v] = lengths(frame);
    const double missed = miss(jet, u, v), all = bend(jet, u, v),
                 size = rounding * jet.value().magnitude();
    // f is within `all` of its tangent plane in the mean square, and the plane is integrated
    // exactly. The moments of f are wrong by `missed` in all; the linear function with such moments
    // has a norm at most 7 times as large.
    _parts.unknown[t] = _parts.moments[t] = frame.area * (missed + size);
    _parts.beyond[t] = std::sqrt(frame.area) * (all + 3.5 * missed + size);
    if (_options.spread == nullptr) return;
    spread_smooth(t, jet, all, missed);
    if (!((*_options.spread)[t].values.low > 0)) keep(t);  // a tension must be above 0
  }

  void spread_smooth(std::size_t t, const Jet& jet, double all, double missed) {
    const Centred own = whole(t);
    Spread& spread = (*_options.spread)[t];
    const double average = sum_of(t) / own.area;
    const double off = slope(jet, own.reach_x, own.reach_y) +
                       jet.of[3].magnitude() * own.reach_x * own.reach_x +
                       jet.of[4].magnitude() * own.reach_x * own.reach_y +
                       jet.of[5].magnitude() * own.reach_y * own.reach_y + all + missed;
    spread.values = {std::max(jet.value().low, average - off),
                     std::min(jet.value().high, average + off)};
    spread.deviation = slope(jet, std::sqrt(own.xx()), std::sqrt(own.yy())) + 2 * all + missed;
  }

  void enclose_alone(std::size_t t) {
    const Centred own = whole(t);
    if (!(own.area > 0)) return;
    Box box;
    for (std::size_t i = 0; i < 3; ++i) box.add(own.x + own.dx[i], own.y + own.dy[i]);
    const Jet jet = enclose_box(box);
    const bool curved = !_options.curved.empty() && _options.curved[t] != 0;
    !curved&& known(jet, own.length_x, own.length_y) ? settle(t, jet) : keep(t);
  }

  /// Keeps a triangle to be quartered.
  void keep(std::size_t t) {
    Quarter one;
    one.cell.triangle = static_cast<std::int32_t>(t);
    measure(one);
    _quarters.push_back(one);
    _first.push_back(one.cell.triangle);
  }

  void measure(Quarter& one) {
    const Centred own = centred(frame_of(_xy, _triangles, at(one.cell.triangle)), one.cell);
    one.area = own.area;
    one.found = enclose(_enclosure, own);
    spend(3);
  }

  double sum_of(std::size_t t) const {
    return _parts.load[3 * t] + _parts.load[3 * t + 1] + _parts.load[3 * t + 2];
  }

  bool divisible(const Quarter& one) const {
    const Frame frame = frame_of(_xy, _triangles, at(one.cell.triangle));
    constexpr double least = 1e3 * std::numeric_limits<double>::epsilon();
    return one.cell.depth < deepest && one.area > 0 &&
           std::sqrt(one.area) > least * (std::abs(frame.x) + std::abs(frame.y));
  }

  /// Quarters the parts of which most is unknown.
  void quarter() {
    using Entry = std::pair<double, std::int64_t>;  // among equals the first one comes first
    std::priority_queue<Entry> queue;
    double unknown = 0, absolute = 0;
    std::size_t without = 0;  // parts of which nothing is known
    std::size_t urgent = 0;   // parts that may have another sign than the rest
    bool refused = false;
    const auto signs = [&](const Quarter& one) {
      return _options.spread != nullptr && one.found.values.low <= 0 && one.found.values.high > 0;
    };
    const auto count = [&](const Quarter& one, int sign) {
      if (std::isfinite(one.found.radius)) {
        unknown += sign * one.found.radius;
        absolute += sign * std::abs(one.found.integral);
      } else {
        without = sign > 0 ? without + 1 : without - 1;
      }
    };
    const auto offer = [&](std::size_t i) {
      count(_quarters[i], 1);
      const Quarter& one = _quarters[i];
      refused = refused || (_options.spread != nullptr && one.found.values.high <= 0);
      if (!divisible(one)) return;
      if (signs(one)) ++urgent;
      if (signs(one) || one.found.radius > 0)
        queue.emplace(signs(one) ? infinite : one.found.radius, -static_cast<std::int64_t>(i));
    };
    for (std::size_t i = 0; i < _quarters.size(); ++i) offer(i);
    while (!queue.empty() && _work > 0 && !refused) {
      stop::look("integrating a load");
      const auto enough = [&] {
        _proof.absolute = std::max(_options.absolute, absolute);
        return without == 0 && urgent == 0 && unknown <= _options.tolerance * _proof.absolute;
      };
      if (enough()) {  // large terms that were subtracted have left their rounding
        unknown = absolute = 0;
        for (const Quarter& one : _quarters)
          if (one.children < 0) count(one, 1);
        if (enough()) break;
      }
      const auto i = static_cast<std::size_t>(-queue.top().second);
      queue.pop();
      if (signs(_quarters[i])) --urgent;
      count(_quarters[i], -1);
      _quarters[i].children = static_cast<std::int32_t>(_quarters.size());
      for (const Cell& cell : Cell(_quarters[i].cell).quarters()) {
        Quarter child;
        child.cell = cell;
        measure(child);
        _quarters.push_back(child);
        offer(_quarters.size() - 1);
      }
    }
    conclude();
  }

  /// Adds the quarters up to the results of the triangles.
  void conclude() {
    const std::size_t roots = _first.size();
    struct Sum {
      double integral = 0, radius = 0, at_b = 0, at_c = 0;
      double modelled = 0, b = 0, c = 0, off = 0;  // of the models of Enclosed::moments
    };
    std::vector<Sum> sums(_quarters.size());
    for (std::size_t i = _quarters.size(); i-- > 0;) {
      const Quarter& one = _quarters[i];
      Sum& sum = sums[i];
      if (one.children < 0) {
        const Place middle = one.cell.at(1.0 / 3, 1.0 / 3);
        const Modelled& model = one.found.moments;
        const Frame frame = frame_of(_xy, _triangles, at(one.cell.triangle));
        const double twice = frame.bx * frame.cy - frame.by * frame.cx;
        sum = {one.found.integral,
               one.found.radius,
               one.found.integral * middle.b,
               one.found.integral * middle.c,
               model.integral,
               model.integral * middle.b + (model.x * frame.cy - model.y * frame.cx) / twice,
               model.integral * middle.c + (model.y * frame.bx - model.x * frame.by) / twice,
               model.radius};
        continue;
      }
      for (std::size_t k = 0; k < 4; ++k) {
        const Sum& child = sums[at(one.children) + k];
        sum.integral += child.integral;
        sum.radius += child.radius;
        sum.at_b += child.at_b;
        sum.at_c += child.at_c;
        sum.modelled += child.modelled;
        sum.b += child.b;
        sum.c += child.c;
        sum.off += child.off;
      }
    }
    for (std::size_t i = 0; i < roots; ++i) {
      const auto t = at(_first[i]);
      const Sum& sum = sums[i];
      const double slack = sum.radius + rounding * std::abs(sum.integral);
      // The samples are closer than the rounding here, unless they missed something.
      const double doubt = 1e-9 * (std::abs(sum.integral) + mean() * whole(t).area);
      if (std::abs(sum_of(t) - sum.integral) > slack + doubt)
        replace(t, {sum.integral - sum.at_b - sum.at_c, sum.at_b, sum.at_c});
      _parts.unknown[t] = std::abs(sum_of(t) - sum.integral) + slack;
      const double* own = &_parts.load[3 * t];
      _parts.moments[t] = std::abs(own[0] - (sum.modelled - sum.b - sum.c)) +
                          std::abs(own[1] - sum.b) + std::abs(own[2] - sum.c) + sum.off +
                          rounding * std::abs(sum.modelled);
    }
    bound_rest(roots);
  }

  void replace(std::size_t t, const std::array<double, 3>& moments) {
    for (std::size_t i = 0; i < 3; ++i) {
      double& own = _parts.load[3 * t + i];
      _load[at(_triangles[3 * t + i])] += moments[i] - own;
      own = moments[i];
    }
  }

  /// Bounds f - f_h on the triangles that were quartered: by its norm, or by a flux between the
  /// quarters at all levels, whichever is less (THEORY.md).
  void bound_rest(std::size_t roots) {
    struct Rest {
      double sum = 0;      ///< int (f - f_h)
      double radius = 0;   ///< bound of the error of `sum`
      double squared = 0;  ///< >= int (f - f_h)^2
      double dual = 0;     ///< >= the square of int (f - f_h - its mean) v / |grad v|
    };
    std::vector<Rest> rests(_quarters.size());
    for (std::size_t i = _quarters.size(); i-- > 0;) {
      const Quarter& one = _quarters[i];
      const auto t = at(one.cell.triangle);
      const Frame frame = frame_of(_xy, _triangles, t);
      const Centred own = centred(frame, one.cell);
      Rest& rest = rests[i];
      if (one.children < 0) {
        const Linear linear(&_parts.load[3 * t], frame.area);
        const auto less_linear = [&](const Interval& values) {
          Interval off{infinite, -infinite};
          for (const Place& corner : one.cell.corners) {
            const double value = linear(corner);
            off = hull(off, {values.low - value, values.high - value});
          }
          return off;
        };
        const Interval beside = less_linear(one.found.beside), all = less_linear(one.found.values);
        const double most = beside.magnitude(), half = beside.radius(),
                     in_strips = all.magnitude() + beside.magnitude(),
                     strips = one.found.strips > 0 ? one.found.strips * in_strips * in_strips : 0;
        const double by_poincare = own.diameter() / j_11;
        rest = {one.found.integral - own.area * linear(one.cell.at(1.0 / 3, 1.0 / 3)),
                one.found.radius, own.area * most * most + strips,
                by_poincare * by_poincare * (own.area * half * half + strips)};
        continue;
      }
      for (std::size_t k = 0; k < 4; ++k) {
        const Rest& child = rests[at(one.children) + k];
        rest.sum += child.sum;
        rest.radius += child.radius;
        rest.squared += child.squared;
        rest.dual += child.dual;
      }
      // The quarter at corner k sends its surplus to the fourth one, through the side between them.
      double corners = 0, through_centre = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const Rest& child = rests[at(one.children) + k];
        const double flux =
            std::abs(child.sum - 0.25 * rest.sum) + child.radius + 0.25 * rest.radius;
        // The norm of a flux of 1 through one side of a triangle: |(x - P) / (2 area)|.
        const double norm = std::sqrt(0.25 * own.squared_distance(k) / own.area);
        corners += flux * norm * flux * norm;
        through_centre += flux * norm;
      }
      const double sum =
          std::sqrt(rest.dual) + std::sqrt(corners + through_centre * through_centre);
      rest.dual = sum * sum;
    }
    for (std::size_t i = 0; i < roots; ++i) {
      const auto t = at(_first[i]);
      const Centred own = whole(t);
      // By Poincare's inequality a norm `beyond` acts like a flux of `beyond` diameter / j_11.
      const double by_flux = std::sqrt(rests[i].dual) * j_11 / own.diameter();
      const double by_norm = std::sqrt(rests[i].squared);
      _parts.beyond[t] = std::isfinite(by_norm) ? std::min(by_norm, by_flux) : by_flux;
      if (_options.spread != nullptr) spread_of(i);
    }
  }

  void spread_of(std::size_t root) {
    Spread spread{{infinite, -infinite}, 0};
    const auto t = at(_first[root]);
    const double area = whole(t).area, average = sum_of(t) / area;
    std::vector<std::size_t> open{root};
    while (!open.empty()) {
      const Quarter& one = _quarters[open.back()];
      open.pop_back();
      if (one.children >= 0) {
        for (std::size_t k = 0; k < 4; ++k) open.push_back(at(one.children) + k);
        continue;
      }
      const Interval& values = one.found.values;
      const double least = values.high <= 0 ? -infinite : values.low;  // to be proved first
      if (least < _lowest) {
        _lowest = least;
        const Centred own = centred(frame_of(_xy, _triangles, t), one.cell);
        _proof.lowest_x = own.x;
        _proof.lowest_y = own.y;
      }
      spread.values = hull(spread.values, values);
      const double off = std::max(std::abs(values.low - average), std::abs(values.high - average));
      spread.deviation += one.area / area * off * off;
    }
    spread.deviation = std::sqrt(spread.deviation);
    (*_options.spread)[t] = spread;
  }

  std::span<const double> _xy;
  std::span<const std::int32_t> _triangles;
  Enclosure _enclosure;
  ForceParts& _parts;
  std::span<double> _load;
  const ProofOptions& _options;
  double _work;
  std::vector<std::int32_t> _order;
  double _area = 0, _most_unknown = 0, _lowest = infinite;
  Proof _proof;
  std::vector<Quarter> _quarters;    ///< the whole triangles first
  std::vector<std::int32_t> _first;  ///< their triangles' numbers
};

}  // namespace

Proof prove_load(std::span<const double> xy, std::span<const std::int32_t> triangles,
                 const expression::Function& f, ForceParts& parts, std::span<double> load,
                 const ProofOptions& options) {
  return ForceProver(xy, triangles, f, parts, load, options)();
}

}  // namespace anticrack::fem
