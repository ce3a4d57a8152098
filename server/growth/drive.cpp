// SPDX-License-Identifier: GPL-3.0-or-later
#include "growth/drive.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace anticrack::growth {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// G that is less than this many times the spread over its radii is that of a closed front.
constexpr double closed_spread = 3;

/// Adds the roots of a quadratic.
void add_roots(const Quadratic& q, std::vector<double>& to) {
  const auto [c, b, a] = q.c;
  const double under = b * b - 4 * a * c;
  if (under < 0) return;
  const double half = -(b + std::copysign(std::sqrt(under), b)) / 2;
  if (a != 0) to.push_back(half / a);
  if (half != 0) to.push_back(c / half);
}

/// p + factor q.
Quadratic sum(const Quadratic& p, double factor, const Quadratic& q) {
  return {{p.c[0] + factor * q.c[0], p.c[1] + factor * q.c[1], p.c[2] + factor * q.c[2]}};
}

/// Where G reaches Gc first on the way from t to `end` (way 1: from below, -1: from above).
std::optional<double> crossing(const Rates& rates, double Gc, double t, double end, int way) {
  const auto reached = [&](double at) { return way * (rates.at(at) - Gc) >= 0; };
  if (reached(t)) return t;
  const auto& G = rates.by_radius;
  std::vector<double> where;
  add_roots(sum(G[0], -Gc, {{1, 0, 0}}), where);
  for (const Quadratic& some : G)  // where the spread closes the front, or no longer does
    for (const Quadratic& other : G)
      if (&some != &other) add_roots(sum(G[0], -closed_spread, sum(some, -1, other)), where);
  std::ranges::sort(where, {}, [way](double at) { return way * at; });
  constexpr double ahead = 1e-12;
  for (const double at : where)
    if (way * (at - t) >= 0 && way * (end - at) >= 0 && reached(at + way * ahead * std::abs(at)))
      return at;
  return {};
}

class Drive {
 public:
  Drive(const Pieces& pieces, const Sought& sought) : _pieces(pieces), _sought(sought) {
    found.starts.assign(sought.toughness.size(), never);
  }

  /// Goes from t on, as far as `limit` says, until each of the fronts is found. Downwards a front
  /// that is not found starts at 0.
  template <class Limit>
  void walk(std::vector<std::size_t> fronts, double t, int way, const Limit& limit) {
    while (!fronts.empty()) {
      const Piece piece = _pieces(t, way);
      std::erase_if(fronts, [&](std::size_t i) {
        const double Gc = _sought.toughness[i];
        const auto root = crossing(piece.rates[i], Gc, t, piece.end, way);
        if (root) found.starts[i] = *root;
        if (!root && way > 0) note_most(piece.rates[i], Gc, t, piece.end);
        return root.has_value();
      });
      t = piece.end;
      if (way > 0 ? t >= limit() : t <= 0) break;
    }
    if (way < 0)
      for (const std::size_t i : fronts) found.starts[i] = 0;
  }

  double least() const {
    return found.starts.empty() ? never : *std::ranges::min_element(found.starts);
  }

  Driven found;

 private:
  void note_most(const Rates& rates, double Gc, double t, double end) {
    const Quadratic& q = rates.by_radius[0];
    const auto note = [&](double at) {
      if (!(at >= t && at <= end) || !std::isfinite(at)) return;
      if (const double part = rates.at(at) / Gc; part > found.most || found.most == 0) {
        found.most = part;
        found.most_at = at;
      }
    };
    note(t);
    note(end);
    if (q.c[2] < 0) note(-q.c[1] / (2 * q.c[2]));
  }

  const Pieces& _pieces;
  const Sought& _sought;
};

}  // namespace

Quadratic polarised(double at_0, double of_square, double together) {
  return {{at_0, together - at_0 - of_square, of_square}};
}

double rate_of(const std::array<double, 3>& by_radius) {
  const auto [least, most] = std::ranges::minmax(by_radius);
  return by_radius[0] <= closed_spread * (most - least) ? 0 : by_radius[0];
}

double Rates::at(double t) const {
  return rate_of({by_radius[0].at(t), by_radius[1].at(t), by_radius[2].at(t)});
}

Driven drive(const Pieces& pieces, const Sought& sought, const std::vector<char>& grows) {
  Drive drive(pieces, sought);
  const std::size_t count = grows.size();
  const auto values = [&](double t) {
    std::vector<double> all(count, std::numeric_limits<double>::quiet_NaN());
    const Piece piece = pieces(t, 1);
    for (std::size_t i = 0; i < count; ++i)
      if (grows[i] != 0) all[i] = piece.rates[i].at(t);
    return all;
  };
  drive.found.alone = values(0);
  drive.found.held = sought.highest > 0 ? values(sought.highest) : drive.found.alone;
  const std::vector<double>& held = drive.found.held;
  const std::vector<double> before = sought.from < sought.highest ? values(sought.from) : held;
  std::vector<std::size_t> waiting, rising, falling;
  for (std::size_t i = 0; i < count; ++i) {
    if (grows[i] == 0) continue;
    const double Gc = sought.toughness[i];
    (held[i] < Gc ? waiting : before[i] < Gc ? rising : falling).push_back(i);
  }
  if (sought.from > 0)
    drive.walk(falling, sought.from, -1, [] { return 0; });
  else
    for (const std::size_t i : falling) drive.found.starts[i] = 0;
  drive.walk(rising, sought.from, 1, [&] { return sought.highest; });
  for (const std::size_t i : rising)  // at the end of its piece, to rounding
    drive.found.starts[i] = std::min(drive.found.starts[i], sought.highest);
  drive.walk(waiting, sought.highest, 1, [&] { return (1 + tie) * drive.least(); });
  return drive.found;
}

}  // namespace anticrack::growth
