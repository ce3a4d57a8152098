// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "fem/integration.hpp"
#include "fem/triangle_rules.hpp"

namespace anticrack::fem {
namespace {

constexpr std::int32_t deepest = 40;
/// A change of more than this fraction of the change before does not count as convergence.
constexpr double slowest = 0.97;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// How far the arguments of steep functions may vary for rules with this many points.
constexpr double room = 2.5;

/// What has been measured of a cell.
struct Measured {
  Cell cell;
  Moments found;
  double error = 0;   ///< estimated error of the worst nodal value
  double before = 0;  ///< the cell's part of the change when its parent was divided
  Trust trust = Trust::sound;
  double area = 0;  ///< area of the whole triangle
};

/// The cells of one call of the sampler; each has one set of the points of `Rule`.
class Batch {
 public:
  explicit Batch(Integration& integration) : _integration(integration) {}

  template <class... Rules>
  const double* sample(std::span<Measured* const> cells, const Rules&... used) {
    std::size_t n = 0;
    for (Measured* const cell : cells) {
      Measured& one = *cell;
      const Frame frame = _integration.frame(one.cell.triangle);
      one.area = frame.area;
      const Place& p = one.cell.corners[0];
      const double x = frame.at_x(p), y = frame.at_y(p);
      const auto to_x = [&](const Place& q) {
        return (q.b - p.b) * frame.bx + (q.c - p.c) * frame.cx;
      };
      const auto to_y = [&](const Place& q) {
        return (q.b - p.b) * frame.by + (q.c - p.c) * frame.cy;
      };
      const double bx = to_x(one.cell.corners[1]), by = to_y(one.cell.corners[1]),
                   cx = to_x(one.cell.corners[2]), cy = to_y(one.cell.corners[2]);
      const auto place = [&](const auto& rule) {
        for (std::size_t i = 0; i < rule.size; ++i) {
          _x[n + i] = x + rule.b[i] * bx + rule.c[i] * cx;
          _y[n + i] = y + rule.b[i] * by + rule.c[i] * cy;
        }
        n += rule.size;
      };
      (place(used), ...);
    }
    const double* values = _integration.f(_x.data(), _y.data(), n);
    _integration.spend(n, _integration.f.cost());
    return values;
  }

  /// Throws if one of n values from `first` on is not finite.
  void require_finite(const double* values, std::size_t first, std::size_t n) const {
    for (std::size_t i = first; i < first + n; ++i)
      _integration.f.function().require_finite(_x[i], _y[i], values[i]);
  }

 private:
  Integration& _integration;
  std::array<double, Sampler::block> _x{}, _y{};
};

/// Means over a cell.
struct Means {
  std::array<double, 3> nodal;  ///< means of f phi_i, with the cell's own phi_i
  double absolute;              ///< mean of |f|
};

template <std::size_t N>
using PerPoint = Eigen::Array<double, N, 1>;
template <std::size_t N>
Eigen::Map<const PerPoint<N>> per_point(const double* values) {
  return Eigen::Map<const PerPoint<N>>(values);
}

template <std::size_t N>
Means means(const TriangleRule<N>& rule, const double* values) {
  const PerPoint<N> part = per_point<N>(rule.weight.data()) * per_point<N>(values);
  const double whole = part.sum(), b = (part * per_point<N>(rule.b.data())).sum(),
               c = (part * per_point<N>(rule.c.data())).sum();
  return {{whole - b - c, b, c}, part.abs().sum()};
}

/// Mean of |f - its linear part|.
template <std::size_t N>
double mean_bend(const TriangleRule<N>& rule, const double* values, const Means& means) {
  const auto [a, b, c] = means.nodal;
  const double whole = 3 * (a + b + c), p = 12 * a - whole, q = 12 * b - whole - p,
               r = 12 * c - whole - p;
  const PerPoint<N> rest =
      per_point<N>(values) - p - q * per_point<N>(rule.b.data()) - r * per_point<N>(rule.c.data());
  return (per_point<N>(rule.weight.data()) * rest.abs()).sum();
}

Moments to_triangle(const Cell& cell, double area, const Means& means) {
  Moments result;
  for (std::size_t k = 0; k < 3; ++k) {
    result.value[0] += area * means.nodal[k];
    result.value[1] += area * means.nodal[k] * cell.corners[k].b;
    result.value[2] += area * means.nodal[k] * cell.corners[k].c;
  }
  result.absolute = area * means.absolute;
  return result;
}

class Refinement {
 public:
  explicit Refinement(Integration& integration) : _integration(integration), _batch(integration) {}

  void operator()(std::vector<Coarse> triangles, std::vector<Measured> cells) {
    choose(triangles, points_a + points_b);
    std::vector<Measured> rest;
    constexpr std::size_t at_once = 4096;  // few enough to stay in the cache
    for (std::size_t first = 0; first < triangles.size(); first += at_once) {
      std::vector<Measured> some;
      for (std::size_t i = first; i < std::min(first + at_once, triangles.size()); ++i) {
        Measured& one = some.emplace_back();
        one.cell.triangle = triangles[i].triangle;
        one.found = triangles[i].found;
      }
      measure_and_settle(some, Known::by_rule_5, rest);
    }
    measure_and_settle(cells, Known::nothing, rest);
    while (!rest.empty()) {
      choose(rest, 4 * (points_a + points_b));
      rest = divide(rest);
    }
  }

 private:
  static constexpr std::size_t points_a = points_of_cell, points_b = rule_12.size;
  enum class Known { nothing, by_rule_5 };

  double area(const Measured& one) const { return one.area * std::abs(one.cell.part()); }

  double allowed(const Measured& one) const {
    return _integration.allowed(one.area, one.cell.share, one.found.absolute);
  }

  void measure_and_settle(std::vector<Measured>& cells, Known known, std::vector<Measured>& rest) {
    measure(cells, known);
    note_size(cells);
    for (Measured& one : cells) settle_or_keep(one, one.error, rest);
  }

  /// Corrects int |f|, as a narrow peak that is most of f may be found only now.
  void note_size(const std::vector<Measured>& cells) {
    double absolute = _integration.settled;
    for (const Measured& one : cells) absolute += one.found.absolute;
    _integration.absolute = std::max(_integration.absolute, absolute);
  }

  /// Keeps the worst cells, as many as the remaining work allows; settles the others with what is
  /// known.
  template <class Part>
  void choose(std::vector<Part>& all, std::size_t points_each) {
    const double each = static_cast<double>(points_each) * (_integration.f.cost() + 3);
    const auto affordable = static_cast<std::size_t>(std::max(0.0, _integration.work) / each);
    if (all.size() <= affordable) return;
    std::stable_sort(all.begin(), all.end(), [](const Part& a, const Part& b) {
      return a.trust != b.trust ? a.trust > b.trust : a.error > b.error;
    });
    for (std::size_t i = affordable; i < all.size(); ++i)
      settle(triangle_of(all[i]), all[i].found, all[i].error, all[i].trust);
    all.resize(affordable);
  }

  static std::int32_t triangle_of(const Coarse& one) { return one.triangle; }
  static std::int32_t triangle_of(const Measured& one) { return one.cell.triangle; }

  void settle(std::int32_t triangle, const Moments& found, double error, Trust trust) {
    if (trust >= Trust::singular) error = infinite;
    if (trust == Trust::unresolved) error = found.absolute;
    _integration.add(triangle, found, error);
  }

  /// Settles a cell, or keeps it to be divided. `left`: its error if it is not divided further.
  void settle_or_keep(Measured& one, double left, std::vector<Measured>& rest) {
    const bool sound = one.error <= allowed(one) && one.trust == Trust::sound;
    if (sound || !one.cell.divisible || one.cell.depth >= deepest || at_rounding(one)) {
      settle(one.cell.triangle, one.found, sound ? one.error : left, one.trust);
    } else {
      one.error = left;
      rest.push_back(one);
    }
  }

  /// Whether the cell is so small that points of its parts would coincide.
  bool at_rounding(const Measured& one) const {
    const Frame frame = _integration.frame(one.cell.triangle);
    constexpr double least = 1e3 * std::numeric_limits<double>::epsilon();
    return std::sqrt(area(one)) <= least * (std::abs(frame.x) + std::abs(frame.y));
  }

  std::vector<Measured> divide(const std::vector<Measured>& parents) {
    std::vector<Measured> children;
    children.reserve(4 * parents.size());
    for (const Measured& parent : parents)
      for (const Cell& cell : parent.cell.quarters()) children.push_back({cell, {}});
    measure(children, Known::nothing);
    note_size(children);
    std::vector<Measured> rest;
    for (std::size_t i = 0; i < parents.size(); ++i) {
      Moments sum;
      double errors = 0;
      for (std::size_t k = 4 * i; k < 4 * i + 4; ++k) {
        sum += children[k].found;
        errors += children[k].error;
      }
      const double change = difference(sum, parents[i].found);
      const double left = tail(change, parents[i]), scale = errors > 0 ? left / errors : 0;
      const std::size_t known = rest.size();
      const bool converges = parents[i].before > 0 && change <= slowest * parents[i].before;
      for (std::size_t k = 4 * i; k < 4 * i + 4; ++k) {
        Measured& child = children[k];
        child.before = child.error;
        const double own = child.error * std::max(1.0, scale);
        if (converges && child.trust == Trust::singular) {
          child.trust = Trust::sound;
          child.error = own;
        }
        settle_or_keep(child, own, rest);
      }
      // Cells that go on share the change in proportion to their errors, as along a line twice as
      // many go on each time.
      double going_on = 0;
      for (std::size_t k = known; k < rest.size(); ++k) going_on += rest[k].before;
      for (std::size_t k = known; k < rest.size(); ++k)
        rest[k].before = going_on > 0 ? change * rest[k].before / going_on : 0;
    }
    return rest;
  }

  /// The sum of all further changes, if they decay as between the last two.
  static double tail(double change, const Measured& parent) {
    if (!(parent.before > 0)) return 0;
    const double decay = change / parent.before;
    if (decay > slowest) {
      const bool diverges = parent.cell.depth > 4 && parent.trust >= Trust::singular;
      return diverges ? infinite : 32 * change;
    }
    return change * decay / (1 - decay);
  }

  /// Replaces what is known of a cell; returns the greatest change of a nodal value.
  double replace(Measured& one, const Means& by) {
    const Moments found = to_triangle(one.cell, area(one), by);
    return fem::difference(std::exchange(one.found, found), found);
  }

  /// Samples cells by one rule and calls judge(cell, means, its number, its values).
  template <class Rule, class Judge>
  void measure_by(const Rule& rule, std::span<Measured* const> cells, const Judge& judge) {
    constexpr std::size_t at_once = Sampler::block / Rule::size;
    for (std::size_t first = 0; first < cells.size(); first += at_once) {
      const auto some = cells.subspan(first, std::min(at_once, cells.size() - first));
      const double* values = _batch.sample(some, rule);
      for (std::size_t i = 0; i < some.size(); ++i) {
        const Means found = means(rule, values + i * rule.size);
        if (!std::isfinite(found.absolute)) _batch.require_finite(values, i * rule.size, rule.size);
        judge(*some[i], found, first + i, values + i * rule.size);
      }
    }
  }

  void measure(std::vector<Measured>& cells, Known known) {
    std::vector<Measured*> all;
    all.reserve(cells.size());
    for (Measured& one : cells) all.push_back(&one);
    if (_integration.exact) {
      measure_by(rule_5, all,
                 [&](Measured& one, const Means& by_5, std::size_t, const double* values) {
                   replace(one, by_5);
                   // There is a jump in it.
                   one.error = one.cell.divisible ? 0 : area(one) * mean_bend(rule_5, values, by_5);
                 });
      return;
    }
    std::vector<Measured*> finer;
    std::vector<double> bends;
    measure_by_8(all, known, finer, bends);
    measure_by(rule_12, finer, [&](Measured& one, const Means& by_12, std::size_t number, auto) {
      const double change = replace(one, by_12), part = std::cbrt(change / bends[number]);
      one.error = change * std::min(1.0, 10 * part * part);
    });
  }

  /// Measures by rule_8, and by rule_5 if not known; finds those that rule_12 is likely to settle.
  void measure_by_8(std::span<Measured* const> cells, Known known, std::vector<Measured*>& finer,
                    std::vector<double>& bends) {
    const std::size_t first_of_8 = known == Known::nothing ? rule_5.size : 0;
    const std::size_t points = first_of_8 + rule_8.size, at_once = Sampler::block / points;
    for (std::size_t first = 0; first < cells.size(); first += at_once) {
      const auto some = cells.subspan(first, std::min(at_once, cells.size() - first));
      const double* values =
          first_of_8 > 0 ? _batch.sample(some, rule_5, rule_8) : _batch.sample(some, rule_8);
      if (_integration.f.watches()) _integration.f.note_peaks(some.size() * points);
      for (std::size_t i = 0; i < some.size(); ++i) {
        Measured& one = *some[i];
        const double* own = values + i * points;
        if (first_of_8 > 0) replace(one, means(rule_5, own));
        const Means by_8 = means(rule_8, own + first_of_8);
        if (!std::isfinite(by_8.absolute + one.found.absolute))
          _batch.require_finite(values, i * points, points);
        const double bend = area(one) * mean_bend(rule_8, own + first_of_8, by_8) / 3,
                     change = replace(one, by_8);
        // The change is the error of rule_5; that of rule_8 is as much less as convergence
        // promises.
        one.error = bend > 0 ? change * std::min(1.0, 10 * change / bend) : 0;
        one.trust = _integration.f.watches() ? _integration.f.trust(i * points, points, room)
                                             : Trust::sound;
        if (!one.cell.divisible) one.error = std::max(one.error, bend);  // there is a jump in it
        if (one.error > allowed(one) && one.error < 0.3 * bend) {
          finer.push_back(&one);
          bends.push_back(bend);
        }
      }
    }
  }

  Integration& _integration;
  Batch _batch;
};

}  // namespace

void refine_cells(Integration& integration, std::vector<Coarse> triangles,
                  std::vector<Cell> cells) {
  std::vector<Measured> all;
  all.reserve(cells.size());
  for (const Cell& cell : cells) all.push_back({cell, {}});
  Refinement refinement(integration);
  refinement(std::move(triangles), std::move(all));
}

}  // namespace anticrack::fem
