// SPDX-License-Identifier: GPL-3.0-or-later
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
/// What changes by more than this part of the change before is not taken for convergent.
constexpr double slowest = 0.97;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// How far the arguments of steep functions may vary for rules of so many points.
constexpr double room = 2.5;

/// What is known of a cell.
struct Measured {
  Cell cell;
  Moments found;
  double error = 0;   ///< of the worst nodal value, estimated
  double before = 0;  ///< by how much dividing changed what the cell came from, its part
  Trust trust = Trust::sound;
  double area = 0;  ///< of the whole triangle
};

/// By local barycentric coordinates.
using Nodal = std::array<double, 3>;

/// Cells of one call of the sampler, `Rule` after `Rule` for each.
class Batch {
 public:
  explicit Batch(Integration& integration) : _integration(integration) {}

  template <class... Rules>
  const double* sample(std::span<Measured> cells, const Rules&... used) {
    std::size_t n = 0;
    for (Measured& one : cells) {
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

  /// Throws if a value among n, from `first` on, is not finite.
  void require_finite(const double* values, std::size_t first, std::size_t n) const {
    for (std::size_t i = first; i < first + n; ++i) {
      _integration.f.function().require_finite(_x[i], _y[i], values[i]);
    }
  }

 private:
  Integration& _integration;
  std::array<double, Sampler::block> _x{}, _y{};
};

template <class Rule>
Nodal moments(const Rule& rule, const double* values) {
  double whole = 0, b = 0, c = 0;
  for (std::size_t i = 0; i < rule.size; ++i) {
    const double part = rule.weight[i] * values[i];
    whole += part;
    b += part * rule.b[i];
    c += part * rule.c[i];
  }
  return {whole - b - c, b, c};
}

double square(double a) {
  return a * a;
}

double difference(const Nodal& p, const Nodal& q) {
  return std::max({std::abs(p[0] - q[0]), std::abs(p[1] - q[1]), std::abs(p[2] - q[2])});
}

/// Mean of |f| and of what a straight line leaves of f.
template <class Rule>
std::pair<double, double> sizes(const Rule& rule, const double* values, const Nodal& nodal) {
  const double whole = nodal[0] + nodal[1] + nodal[2];
  const double p = 12 * nodal[0] - 3 * whole, q = 12 * nodal[1] - 3 * whole - p,
               r = 12 * nodal[2] - 3 * whole - p;
  double absolute = 0, bend = 0;
  for (std::size_t i = 0; i < rule.size; ++i) {
    absolute += rule.weight[i] * std::abs(values[i]);
    bend += rule.weight[i] * std::abs(values[i] - p - q * rule.b[i] - r * rule.c[i]);
  }
  return {absolute, bend};
}

Moments to_triangle(const Cell& cell, double area, const Nodal& nodal, double absolute) {
  Moments result;
  for (std::size_t k = 0; k < 3; ++k) {
    result.value[0] += area * nodal[k];
    result.value[1] += area * nodal[k] * cell.corners[k].b;
    result.value[2] += area * nodal[k] * cell.corners[k].c;
  }
  result.absolute = area * absolute;
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
        some.emplace_back().cell.triangle = triangles[i].triangle;
      }
      measure_and_settle(some, rest);
    }
    measure_and_settle(cells, rest);
    while (!rest.empty()) {
      choose(rest, 4 * (points_a + points_b));
      rest = divide(rest);
    }
  }

 private:
  static constexpr std::size_t points_a = points_of_cell, points_b = rule_12.size;

  double area(const Measured& one) const { return one.area * std::abs(one.cell.part()); }

  double allowed(const Measured& one) const {
    return _integration.allowed(one.area, one.cell.share, one.found.absolute);
  }

  void measure_and_settle(std::vector<Measured>& cells, std::vector<Measured>& rest) {
    measure(cells);
    note_size(cells);
    for (Measured& one : cells) settle_or_keep(one, one.error, rest);
  }

  /// A narrow peak may be most of f, and found only now.
  void note_size(const std::vector<Measured>& cells) {
    double absolute = _integration.settled;
    for (const Measured& one : cells) absolute += one.found.absolute;
    _integration.absolute = std::max(_integration.absolute, absolute);
  }

  /// Leaves those that are worth the work that is left, the worst; settles the others with what is
  /// known.
  template <class Known>
  void choose(std::vector<Known>& all, std::size_t points_each) {
    const double each = static_cast<double>(points_each) * (_integration.f.cost() + 3);
    const auto affordable = static_cast<std::size_t>(std::max(0.0, _integration.work) / each);
    if (all.size() <= affordable) return;
    std::stable_sort(all.begin(), all.end(), [](const Known& a, const Known& b) {
      return a.trust != b.trust ? a.trust > b.trust : a.error > b.error;
    });
    for (std::size_t i = affordable; i < all.size(); ++i) {
      settle(triangle_of(all[i]), all[i].found, all[i].error, all[i].trust);
    }
    all.resize(affordable);
  }

  static std::int32_t triangle_of(const Coarse& one) { return one.triangle; }
  static std::int32_t triangle_of(const Measured& one) { return one.cell.triangle; }

  void settle(std::int32_t triangle, const Moments& found, double error, Trust trust) {
    if (trust >= Trust::singular) error = infinite;
    if (trust == Trust::unresolved) error = found.absolute;
    _integration.add(triangle, found, error);
  }

  /// `left`: the error if it is not divided further.
  void settle_or_keep(Measured& one, double left, std::vector<Measured>& rest) {
    const bool sound = one.error <= allowed(one) && one.trust == Trust::sound;
    if (sound || !one.cell.divisible || one.cell.depth >= deepest || at_rounding(one)) {
      settle(one.cell.triangle, one.found, sound ? one.error : left, one.trust);
    } else {
      one.error = left;
      rest.push_back(one);
    }
  }

  /// So small that points of its parts would coincide.
  bool at_rounding(const Measured& one) const {
    const Frame frame = _integration.frame(one.cell.triangle);
    constexpr double least = 1e3 * std::numeric_limits<double>::epsilon();
    return std::sqrt(area(one)) <= least * (std::abs(frame.x) + std::abs(frame.y));
  }

  std::vector<Measured> divide(const std::vector<Measured>& parents) {
    std::vector<Measured> children;
    children.reserve(4 * parents.size());
    for (const Measured& parent : parents) {
      for (const Cell& cell : parent.cell.quarters()) children.push_back({cell, {}});
    }
    measure(children);
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
      // What goes on shares the change by its errors: along a line twice as many go on each time.
      double going_on = 0;
      for (std::size_t k = known; k < rest.size(); ++k) going_on += rest[k].before;
      for (std::size_t k = known; k < rest.size(); ++k) {
        rest[k].before = going_on > 0 ? change * rest[k].before / going_on : 0;
      }
    }
    return rest;
  }

  /// All further changes, if they go on like the last two.
  static double tail(double change, const Measured& parent) {
    if (!(parent.before > 0)) return 0;
    const double decay = change / parent.before;
    if (decay > slowest) {
      const bool diverges = parent.cell.depth > 4 && parent.trust >= Trust::singular;
      return diverges ? infinite : 32 * change;
    }
    return change * decay / (1 - decay);
  }

  void measure(std::vector<Measured>& cells) {
    if (_integration.exact) {
      measure_exactly(cells);
      return;
    }
    std::vector<std::size_t> finer;
    const std::span<Measured> all(cells);
    constexpr std::size_t at_once = Sampler::block / points_a;
    for (std::size_t first = 0; first < cells.size(); first += at_once) {
      const auto some = all.subspan(first, std::min(at_once, cells.size() - first));
      const double* values = _batch.sample(some, rule_5, rule_8);
      if (_integration.f.watches()) _integration.f.note_peaks(some.size() * points_a);
      for (std::size_t i = 0; i < some.size(); ++i) {
        measure_coarse(some[i], values, i * points_a);
        if (some[i].error > allowed(some[i]) && some[i].error < 0.3 * _bend) {
          finer.push_back(first + i);
          _bends.push_back(_bend);
        }
      }
    }
    measure_finer(cells, finer);
    _bends.clear();
  }

  void measure_exactly(std::span<Measured> cells) {
    constexpr std::size_t at_once = Sampler::block / rule_5.size;
    for (std::size_t first = 0; first < cells.size(); first += at_once) {
      const auto some = cells.subspan(first, std::min(at_once, cells.size() - first));
      const double* values = _batch.sample(some, rule_5);
      for (std::size_t i = 0; i < some.size(); ++i) {
        const double* own = values + i * rule_5.size;
        const Nodal nodal = moments(rule_5, own);
        const auto [absolute, bend] = sizes(rule_5, own, nodal);
        if (!std::isfinite(absolute)) _batch.require_finite(values, i * rule_5.size, rule_5.size);
        some[i].found = to_triangle(some[i].cell, area(some[i]), nodal, absolute);
        some[i].error = some[i].cell.divisible ? 0 : area(some[i]) * bend;  // a jump is in it
      }
    }
  }

  void measure_coarse(Measured& one, const double* values, std::size_t first) {
    const double* coarse = values + first;
    const double* fine = coarse + rule_5.size;
    const Nodal of_5 = moments(rule_5, coarse), of_8 = moments(rule_8, fine);
    const auto [absolute, bend] = sizes(rule_8, fine, of_8);
    if (!std::isfinite(absolute) || !std::isfinite(of_5[0])) {
      _batch.require_finite(values, first, points_a);
    }
    const double size = area(one);
    one.found = to_triangle(one.cell, size, of_8, absolute);
    _bend = size * bend / 3;
    one.error = size * difference(of_5, of_8);
    // Of the smaller rule; the larger one's is as much less as convergence promises.
    one.error *= std::min(1.0, 10 * one.error / _bend);
    if (!(_bend > 0)) one.error = 0;
    one.trust =
        _integration.f.watches() ? _integration.f.trust(first, points_a, room) : Trust::sound;
    if (!one.cell.divisible) one.error = std::max(one.error, _bend);  // a jump is in it
  }

  void measure_finer(std::vector<Measured>& cells, const std::vector<std::size_t>& chosen) {
    constexpr std::size_t at_once = Sampler::block / points_b;
    std::vector<Measured> some;
    for (std::size_t first = 0; first < chosen.size(); first += at_once) {
      const std::size_t count = std::min(at_once, chosen.size() - first);
      some.clear();
      for (std::size_t i = 0; i < count; ++i) some.push_back(cells[chosen[first + i]]);
      const double* values = _batch.sample(some, rule_12);
      for (std::size_t i = 0; i < count; ++i) {
        Measured& one = cells[chosen[first + i]];
        const double* own = values + i * points_b;
        const Nodal nodal = moments(rule_12, own);
        double absolute = 0;
        for (std::size_t k = 0; k < points_b; ++k) {
          absolute += rule_12.weight[k] * std::abs(own[k]);
        }
        if (!std::isfinite(absolute)) _batch.require_finite(values, i * points_b, points_b);
        const Moments found = to_triangle(one.cell, area(one), nodal, absolute);
        const double change = fem::difference(found, one.found);
        one.found = found;
        one.error = change * std::min(1.0, 10 * square(std::cbrt(change / _bends[first + i])));
      }
    }
  }

  Integration& _integration;
  Batch _batch;
  double _bend = 0;            ///< of the cell last measured
  std::vector<double> _bends;  ///< of those that are measured finer
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
