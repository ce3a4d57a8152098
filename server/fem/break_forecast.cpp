// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/break_forecast.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace anticrack::fem {
namespace {

/// With more jumps on its edges a triangle is not resolved anyway, and chords grow with the square.
constexpr std::size_t most_points = 6;

/// Closer than this to a jump, rounding may decide the side.
constexpr double least_doubt = 1e-10, most_doubt = 1e-2;

}  // namespace

BreakForecast::BreakForecast(const std::array<std::vector<Point>, 3>& edge_jumps) {
  const std::size_t count = edge_jumps[0].size() + edge_jumps[1].size() + edge_jumps[2].size();
  if (count < 3 || count > most_points) {
    return;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (const Point& from : edge_jumps[i]) {
      for (const Point& to : edge_jumps[(i + 1) % 3]) {
        _chords.push_back({from, to});
      }
    }
  }
}

void BreakForecast::add_between_chords(std::vector<double>& ends) const {
  std::vector<double> crossings;
  for (const auto& [from, to] : _chords) {
    const double ahead = _s - from.x, whole = to.x - from.x;
    if (whole != 0 && ahead / whole >= 0 && ahead / whole <= 1) {
      crossings.push_back(from.y + ahead / whole * (to.y - from.y));
    }
  }
  std::sort(crossings.begin(), crossings.end());
  for (std::size_t i = 1; i < crossings.size(); ++i) {
    ends.push_back(0.5 * (crossings[i - 1] + crossings[i]));
  }
}

void BreakForecast::add_around(const std::vector<double>& jumps, std::vector<double>& ends) const {
  for (std::size_t i = 0; i < jumps.size(); ++i) {
    // Of a strip thinner than the doubt, only the middle is sure to be inside.
    const bool apart_below = i == 0 || jumps[i] - jumps[i - 1] > 4 * _doubt;
    const bool apart_above = i + 1 == jumps.size() || jumps[i + 1] - jumps[i] > 4 * _doubt;
    if (apart_below) {
      ends.push_back(jumps[i] - _doubt);
    }
    ends.push_back(apart_above ? jumps[i] + _doubt : 0.5 * (jumps[i] + jumps[i + 1]));
  }
}

std::vector<double> BreakForecast::divide(double s) {
  /// The jumps of line `a`, continued straight to s in the direction that line `b` gives.
  const auto continued = [s](const Jumps& a, const Jumps& b) {
    std::vector<double> t = a.t;
    if (b.t.size() == t.size() && a.s != b.s) {
      for (std::size_t i = 0; i < t.size(); ++i) {
        t[i] += (s - a.s) / (a.s - b.s) * (a.t[i] - b.t[i]);
      }
      std::sort(t.begin(), t.end());
    }
    return t;
  };
  _s = s;
  _expected.clear();
  std::vector<double> ends;
  add_between_chords(ends);
  const auto right = std::lower_bound(_lines.begin(), _lines.end(), s,
                                      [](const Jumps& line, double at) { return line.s < at; });
  const bool from_right = right != _lines.end(), from_left = right != _lines.begin();
  if (from_right && from_left && right->t.size() == right[-1].t.size()) {
    _expected = continued(*right, right[-1]);
    add_around(_expected, ends);
  } else {
    if (from_right) {
      _expected = continued(*right, right + 1 != _lines.end() ? right[1] : *right);
      add_around(_expected, ends);
    }
    if (from_left) {
      _expected = continued(right[-1], right - 1 != _lines.begin() ? right[-2] : right[-1]);
      add_around(_expected, ends);
    }
  }
  std::sort(ends.begin(), ends.end());
  return ends;
}

void BreakForecast::record(std::vector<double> jumps) {
  if (jumps.empty()) {
    return;
  }
  std::sort(jumps.begin(), jumps.end());
  if (jumps.size() == _expected.size()) {
    double worst = 0;
    for (std::size_t i = 0; i < jumps.size(); ++i) {
      worst = std::max(worst, std::abs(jumps[i] - _expected[i]));
    }
    _doubt = std::clamp(std::max(2 * worst, _doubt / 16), least_doubt, most_doubt);
  }
  const auto place = std::lower_bound(_lines.begin(), _lines.end(), _s,
                                      [](const Jumps& line, double at) { return line.s < at; });
  if (place == _lines.end() || place->s != _s) {
    _lines.insert(place, {_s, std::move(jumps)});
  } else if (place->t.size() < jumps.size()) {
    place->t = std::move(jumps);
  }
}

}  // namespace anticrack::fem
