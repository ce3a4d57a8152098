// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/cut_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "fem/switch_view.hpp"
#include "fem/triangle_rules.hpp"
#include "stop/stop.hpp"

namespace anticrack::fem {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// How many cells are sampled at once.
constexpr std::size_t width = Cutter::width;
static_assert(width * places <= expression::Evaluator::block);

/// Cells smaller than this fraction of their triangle are not cut.
constexpr double sliver = 1e-11;
constexpr std::int32_t deepest = 60;

/// A ray from an apex inside or on a cell; at parameter t the switch changes.
struct Ray {
  Place from;
  Place to;  ///< the point at t = 1
  double far;
  double t = 0;
};

/// A triangle whose side opposite to the apex is the line where the switch changes; with `beyond`,
/// the part between that line and the chord as well.
struct Sector {
  Place apex;
  Place u, v;
  bool beyond;
};

/// A cell with a curved line; its corners are rotated so that the odd one comes first.
struct Curved {
  Cell cell;
  double level;
  std::array<int, 3> side;
};

double cross(const Place& o, const Place& p, const Place& q) {
  return (p.b - o.b) * (q.c - o.c) - (p.c - o.c) * (q.b - o.b);
}

/// Error of a rule, if the coefficients of the values in Legendre polynomials go on decaying.
template <std::size_t N>
double line_error(const LineRule<N>& rule, const std::array<double, N>& values) {
  std::array<double, N> coefficients{};
  for (std::size_t i = 0; i < N; ++i) {
    const double z = 2 * rule.at[i] - 1;
    double legendre = 1, before = 0;
    for (std::size_t k = 0; k < N; ++k) {
      const auto degree = static_cast<double>(k);
      coefficients[k] += (2 * degree + 1) * rule.weight[i] * values[i] * legendre;
      const double next = ((2 * degree + 1) * z * legendre - degree * before) / (degree + 1);
      before = std::exchange(legendre, next);
    }
  }
  const double last = std::abs(coefficients[N - 1]);
  const double before = std::max(std::abs(coefficients[N - 2]), std::abs(coefficients[N - 3]));
  return last * std::min(1.0, before > 0 ? 10 * last / before : 10.0);
}

std::vector<expression::Switch> in_order(const expression::Tape& tape) {
  std::vector<expression::Switch> switches = tape.switches();
  // Straight lines come first, as they leave triangles.
  std::stable_partition(switches.begin(), switches.end(),
                        [&](const expression::Switch& one) { return tape.degree(one.of) <= 1; });
  return switches;
}

std::vector<expression::Ref> refs(const std::vector<expression::Switch>& switches) {
  std::vector<expression::Ref> result;
  for (const expression::Switch& one : switches) result.push_back(one.of);
  return result;
}

}  // namespace

class Cutter::Work {
 public:
  Work(Integration& integration)
      : _integration(integration),
        _switches(in_order(integration.f.function().tape())),
        _arguments(integration.f.function().tape(), refs(_switches)),
        _curved(_switches.size()) {}

  bool needed() const noexcept { return !_switches.empty(); }

  double cost() const noexcept {
    constexpr double each = 10;  // ns, measured
    return each * static_cast<double>(_switches.size()) +
           static_cast<double>(places) * _arguments.cost();
  }

  void find(const Frames& at, std::array<bool, width>& cut) {
    Lane drawn{};
    for (std::size_t i = 0; i < width; ++i) {
      const double size = std::max(std::abs(at.bx[i]) + std::abs(at.by[i]),
                                   std::abs(at.cx[i]) + std::abs(at.cy[i]));
      _rounding[i] = epsilon * (std::abs(at.x[i]) + std::abs(at.y[i]) + size) / size;
      drawn[i] = 1 - std::min(1e-2, drawn_in + 4 * _rounding[i]);
    }
    for (std::size_t p = 0; p < places; ++p) {
      const double b = place_b[p] - 1.0 / 3, c = place_c[p] - 1.0 / 3;
      for (std::size_t i = 0; i < width; ++i) {
        const double to_b = 1.0 / 3 + drawn[i] * b, to_c = 1.0 / 3 + drawn[i] * c;
        _x[p * width + i] = at.x[i] + to_b * at.bx[i] + to_c * at.cx[i];
        _y[p * width + i] = at.y[i] + to_b * at.by[i] + to_c * at.cy[i];
      }
    }
    _arguments(_x.data(), _y.data(), width * places);
    cut.fill(false);
    for (std::size_t s = 0; s < _switches.size(); ++s) {
      Lane low, high;
      extremes(_arguments.values(s), places, low, high);
      for (std::size_t i = 0; i < width; ++i) {
        // A bound of `low` and `high` of their SwitchView.
        const double beyond = 8 * (high[i] - low[i]);
        const double least = low[i] - beyond, greatest = high[i] + beyond;
        const bool far = _switches[s].steps ? std::floor(least) == std::floor(greatest)
                                            : least > 0 || greatest < 0;
        if (!far && !cut[i]) cut[i] = view(i, s).level(_switches[s].steps).has_value();
      }
    }
  }

  std::vector<Cell> cut(const std::vector<std::int32_t>& triangles) {
    const double mean = _integration.area / (4 + static_cast<double>(triangles.size()));
    _negligible = _integration.tolerance * mean;
    std::vector<Cell> cells;
    for (const std::int32_t t : triangles) {
      Cell cell;
      cell.triangle = t;
      cells.push_back(cell);
    }
    _integration.work -= static_cast<double>(cells.size()) * price_of_cell();
    while (!cells.empty()) {
      _next.clear();
      for (std::size_t first = 0; first < cells.size(); first += width) {
        const std::span<const Cell> all(cells);
        const auto some = all.subspan(first, std::min(width, cells.size() - first));
        sample(some);
        for (std::size_t i = 0; i < some.size(); ++i) divide(some[i], i);
      }
      for (std::size_t s = 0; s < _switches.size(); ++s) cut_curved(s);
      cells.swap(_next);
    }
    // refine_cells() counts the work of measuring them.
    _integration.work += Integration::price(points_of_cell * _done.size(), _integration.f.cost());
    return std::move(_done);
  }

 private:
  void sample(std::span<const Cell> cells) {
    stop::look("integrating a load");
    for (std::size_t i = 0; i < width; ++i) {
      const Cell& cell = cells[std::min(i, cells.size() - 1)];
      const Frame frame = _integration.frame(cell.triangle);
      const double reach = std::abs(frame.x) + std::abs(frame.y) + frame.size();
      _rounding[i] = epsilon * reach / height(cell, frame);
      const double drawn = 1 - std::min(1e-2, drawn_in + 4 * _rounding[i]);
      for (std::size_t p = 0; p < places; ++p) {
        const Place at = cell.at(1.0 / 3 + drawn * (place_b[p] - 1.0 / 3),
                                 1.0 / 3 + drawn * (place_c[p] - 1.0 / 3));
        _x[p * width + i] = frame.at_x(at);
        _y[p * width + i] = frame.at_y(at);
      }
    }
    _arguments(_x.data(), _y.data(), width * places);
  }

  /// The height of the cell over its longest edge.
  static double height(const Cell& cell, const Frame& frame) {
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Place &p = cell.corners[k], &q = cell.corners[(k + 1) % 3];
      const double b = q.b - p.b, c = q.c - p.c;
      longest =
          std::max(longest, std::hypot(b * frame.bx + c * frame.cx, b * frame.by + c * frame.cy));
    }
    return 2 * frame.area * std::abs(cell.part()) / longest;
  }

  SwitchView view(std::size_t i, std::size_t s) const {
    const double* values = _arguments.values(s);
    std::array<double, places> g{};
    for (std::size_t p = 0; p < places; ++p) g[p] = values[p * width + i];
    return {g, _rounding[i]};
  }

  void divide(const Cell& cell, std::size_t i) {
    std::size_t s = 0;
    std::optional<double> level;
    const bool worth = std::abs(cell.part()) > sliver && cell.depth < deepest;
    for (; worth && s < _switches.size(); ++s) {
      level = view(i, s).level(_switches[s].steps);
      if (level) break;
    }
    if (!level) {
      finish(cell);
      return;
    }
    const SwitchView seen = view(i, s);
    std::array<int, 3> side{};
    for (std::size_t k = 0; k < 3; ++k) side[k] = seen.side(k, *level);
    const bool opposite = side[0] * side[1] < 0 || side[1] * side[2] < 0 || side[2] * side[0] < 0;
    if (_integration.work <= 0)
      finish_uncut(cell);
    else if (seen.straight() && opposite)
      cut_straight(cell, seen, *level, side);
    else if (seen.simple(*level, side, _switches[s].steps) && !others(i, s))
      turn(cell, seen, *level, side, _curved[s].emplace_back());
    else
      quarter(cell);
  }

  bool others(std::size_t i, std::size_t s) const {
    while (++s < _switches.size())
      if (view(i, s).level(_switches[s].steps)) return true;
    return false;
  }

  /// Orders the corners: first the one on the line if the line passes between the two others, else
  /// the one alone on its side; last the one farther from the line.
  static void turn(const Cell& cell, const SwitchView& seen, double level,
                   const std::array<int, 3>& side, Curved& result) {
    const std::size_t k = odd_corner(side);
    std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
    if (std::abs(seen.g[l] - level) > std::abs(seen.g[m] - level)) std::swap(l, m);
    const auto& corners = cell.corners;
    result = {cell, level, {side[k], side[l], side[m]}};
    result.cell.corners = {corners[k], corners[l], corners[m]};
  }

  void finish(const Cell& cell) {
    if (std::abs(cell.part()) > 0) _done.push_back(cell);
  }

  void finish_uncut(Cell cell) {
    cell.divisible = false;
    finish(cell);
  }

  void quarter(const Cell& cell) {
    const double size = _integration.frame(cell.triangle).area * std::abs(cell.part());
    if (size <= _negligible || cell.depth >= deepest || _integration.work <= 0)
      finish_uncut(cell);
    else
      for (const Cell& part : cell.quarters()) push(part);
  }

  void push(const Cell& cell, const Place& p, const Place& q, const Place& r) {
    Cell part = cell.with(p, q, r, 0.5);
    ++part.depth;
    push(part);
  }
  /// Adds a cell, and counts the least work that it will take.
  void push(const Cell& cell) {
    _next.push_back(cell);
    _integration.work -= price_of_cell();
  }
  double price_of_cell() const {
    constexpr double looking = 200;
    return looking + Integration::price(places, _arguments.cost()) +
           Integration::price(points_of_cell, _integration.f.cost());
  }

  void cut_straight(const Cell& cell, const SwitchView& seen, double level,
                    const std::array<int, 3>& side) {
    const std::size_t k = odd_corner(side), l = (k + 1) % 3, m = (k + 2) % 3;
    const auto& [p, q, r] = std::array{cell.corners[k], cell.corners[l], cell.corners[m]};
    const auto crossing = [&](std::size_t from, std::size_t to) {
      const double at_from = seen.g[from] - level, at_to = seen.g[to] - level;
      return between(cell.corners[from], cell.corners[to], at_from / (at_from - at_to));
    };
    if (side[k] == 0) {
      const Place a = crossing(l, m);
      push(cell, p, q, a);
      push(cell, p, a, r);
      return;
    }
    const Place a = crossing(k, l), b = crossing(k, m);
    push(cell, p, a, b);
    push(cell, a, q, r);
    push(cell, a, r, b);
  }

  /// Cuts the cells that have one curve of switch s.
  void cut_curved(std::size_t s) {
    std::vector<Curved> curved;
    curved.swap(_curved[s]);
    if (curved.empty()) return;
    std::vector<Ray> ends(2 * curved.size());
    for (std::size_t i = 0; i < curved.size(); ++i) {
      const auto& [cell, level, side] = curved[i];
      const auto& [p, q, r] = cell.corners;
      ends[2 * i] = side[0] == 0 ? Ray{q, r, 1} : Ray{p, q, 1};
      ends[2 * i + 1] = side[0] == 0 ? Ray{q, r, 1} : Ray{p, r, 1};
    }
    follow(s, curved, ends, 2);
    std::vector<std::array<Sector, 2>> sectors(curved.size());
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < curved.size(); ++i) {
      sectors[i] = sectors_of(curved[i], ends[2 * i].t, ends[2 * i + 1].t);
      for (const Sector& sector : sectors[i]) {
        for (const double at : line_5.at) {
          const Place to = between(sector.u, sector.v, at);
          rays.push_back({sector.apex, to, far_end(curved[i].cell, sector.apex, to)});
        }
      }
    }
    follow(s, curved, rays, 10);
    for (std::size_t i = 0; i < curved.size(); ++i) {
      const std::span<const Ray, 10> own(&rays[10 * i], 10);
      if (ends[2 * i].t < 0 || ends[2 * i + 1].t < 0 || !add_sectors(curved[i], sectors[i], own))
        quarter(curved[i].cell);
    }
  }

  /// The parameter at which a ray leaves the cell, in units of its `to`: where the barycentric
  /// coordinate of its apex, a corner, is 0.
  static double far_end(const Cell& cell, const Place& apex, const Place& to) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (cell.corners[k].b == apex.b && cell.corners[k].c == apex.c) {
        const double left = cross(to, cell.corners[(k + 1) % 3], cell.corners[(k + 2) % 3]);
        return 1 / std::max(1e-9, 1 - left / cell.part());
      }
    }
    return 1;
  }

  std::array<Sector, 2> sectors_of(const Curved& one, double t, double other_t) {
    const auto& [p, q, r] = one.cell.corners;
    const auto& side = one.side;
    if (side[0] == 0) {  // from corner p to the edge q r
      const Place a = between(q, r, t);
      return {{{q, p, a, false}, {r, p, a, false}}};
    }
    if (side[1] == 0 && side[2] == 0) return {{{p, q, r, true}, {p, q, q, false}}};
    const Place a = between(p, q, t), b = between(p, r, other_t);
    return {{{p, a, b, false}, {r, a, b, false}}};
  }

  /// Finds where the switch changes along rays, `each` of them for every cell; t < 0: nowhere.
  void follow(std::size_t s, const std::vector<Curved>& curved, std::span<Ray> rays,
              std::size_t each) {
    constexpr std::size_t block = expression::Evaluator::block;
    constexpr int halvings = 26;  // a secant squares the error that they leave
    const expression::Ref root = _switches[s].of;
    expression::Evaluator argument(_integration.f.function().tape(), {&root, 1});
    std::array<double, block> low{}, high{}, at_low{}, at_high{}, off{};
    for (std::size_t first = 0; first < rays.size(); first += block) {
      const std::size_t n = std::min(block, rays.size() - first);
      const auto some = rays.subspan(first, n);
      const auto measure = [&](auto&& part) {
        stop::look("integrating a load");
        for (std::size_t i = 0; i < n; ++i) {
          const Frame frame = _integration.frame(curved[(first + i) / each].cell.triangle);
          const Place at = between(some[i].from, some[i].to, part(i));
          _x[i] = frame.at_x(at);
          _y[i] = frame.at_y(at);
        }
        argument(_x.data(), _y.data(), n);
        _integration.spend(n, argument.cost());
        for (std::size_t i = 0; i < n; ++i)
          off[i] = argument.values(0)[i] - curved[(first + i) / each].level;
      };
      measure([&](std::size_t i) { return drawn_in * some[i].far; });
      at_low = off;
      measure([&](std::size_t i) { return (1 - drawn_in) * some[i].far; });
      at_high = off;
      low.fill(0);
      for (std::size_t i = 0; i < n; ++i) {
        high[i] = some[i].far;
        // At an end of the line, rounding may put the change outside the ray.
        const bool nearly = std::abs(at_high[i]) < 1e-6 * std::abs(at_low[i]);
        some[i].t = at_low[i] * at_high[i] < 0 ? 0 : nearly ? high[i] : -1;
      }
      for (int k = 0; k < halvings; ++k) {
        measure([&](std::size_t i) { return 0.5 * (low[i] + high[i]); });
        for (std::size_t i = 0; i < n; ++i) {
          const bool upper = off[i] * at_low[i] <= 0;
          (upper ? high[i] : low[i]) = 0.5 * (low[i] + high[i]);
          (upper ? at_high[i] : at_low[i]) = off[i];
        }
      }
      for (std::size_t i = 0; i < n; ++i) {
        const double part = at_low[i] / (at_low[i] - at_high[i]);
        if (some[i].t == 0) some[i].t = low[i] + part * (high[i] - low[i]);
      }
    }
  }

  bool add_sectors(const Curved& one, const std::array<Sector, 2>& sectors,
                   std::span<const Ray, 10> rays) {
    if (std::any_of(rays.begin(), rays.end(), [](const Ray& ray) { return ray.t < 0; }))
      return false;
    const Frame frame = _integration.frame(one.cell.triangle);
    constexpr std::size_t points = line_4.size;
    std::array<Place, 60> at{};
    std::array<double, 60> weight{};
    std::size_t n = 0;
    const auto place = [&](const Ray& ray, double scale, double from, double to) {
      for (std::size_t j = 0; j < points; ++j) {
        const double t = from + line_4.at[j] * (to - from);
        at[n] = between(ray.from, ray.to, t);
        weight[n] = scale * line_4.weight[j] * (to - from) * t;
        _x[n] = frame.at_x(at[n]);
        _y[n] = frame.at_y(at[n]);
        ++n;
      }
    };
    for (std::size_t k = 0; k < 2; ++k) {
      const Sector& sector = sectors[k];
      const double scale = 2 * frame.area * std::abs(cross(sector.apex, sector.u, sector.v));
      if (scale == 0) continue;
      for (std::size_t i = 0; i < 5; ++i) place(rays[5 * k + i], scale, 0, rays[5 * k + i].t);
      for (std::size_t i = 0; i < 5 && sector.beyond; ++i)
        place(rays[5 * k + i], scale, rays[5 * k + i].t, 1);
    }
    const double* f = _integration.f(_x.data(), _y.data(), n);
    _integration.spend(n, _integration.f.cost());
    Moments found;
    double error = 0;
    for (std::size_t first = 0; first < n; first += 5 * points) {  // sector or the part beyond
      std::array<double, 5> along{};
      for (std::size_t i = 0; i < 5; ++i) {
        std::array<double, points> across{};
        double size = 0;
        for (std::size_t j = 0; j < points; ++j) {
          const std::size_t m = first + points * i + j;
          _integration.f.function().require_finite(_x[m], _y[m], f[m]);
          found.add(line_5.weight[i] * weight[m], at[m], f[m]);
          across[j] = f[m];
          size += weight[m];
          along[i] += weight[m] * f[m];
        }
        error += line_5.weight[i] * size * line_error(line_4, across);
      }
      error += line_error(line_5, along);
    }
    if (error > _integration.allowed(frame.area, one.cell.share, found.absolute) &&
        std::abs(one.cell.part()) * frame.area > _negligible && _integration.work > 0)
      return false;
    _integration.curved.resize(_integration.triangles.size() / 3);
    _integration.curved[static_cast<std::size_t>(one.cell.triangle)] = 1;
    _integration.add(one.cell.triangle, found, error);
    if (one.side[0] != 0 && !sectors[0].beyond)  // the rest of the cell is a triangle
      push(one.cell, sectors[0].u, one.cell.corners[1], one.cell.corners[2]);
    return true;
  }

  Integration& _integration;
  std::vector<expression::Switch> _switches;
  expression::Evaluator _arguments;
  std::array<double, expression::Evaluator::block> _x{}, _y{};
  std::array<double, width> _rounding{};
  double _negligible = 0;  ///< area
  std::vector<Cell> _next;
  std::vector<std::vector<Curved>> _curved;  ///< by switch
  std::vector<Cell> _done;
};

Cutter::Cutter(Integration& integration) : _work(std::make_unique<Work>(integration)) {}
Cutter::~Cutter() = default;

bool Cutter::needed() const noexcept { return _work->needed(); }

double Cutter::cost() const noexcept { return _work->cost(); }

void Cutter::find(const Frames& frames, std::array<bool, width>& cut) { _work->find(frames, cut); }

std::vector<Cell> Cutter::cut(const std::vector<std::int32_t>& triangles) {
  return _work->cut(triangles);
}

}  // namespace anticrack::fem
