// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "fem/sampled_triangle.hpp"

namespace anticrack::fem {

/// Says where a line s = const is to be divided so that no strip next to a jump is stepped over:
/// strips are thin near a crossing of jumps, between close curves, and where a crossing lies by an
/// edge. A jump that is forecast well is also located sooner. Coordinates (s, t) as Point, the
/// triangle's size being 1. One per swept triangle; lines may come in any order.
class BreakForecast {
 public:
  /// Where the field jumps on each of the three edges.
  explicit BreakForecast(const std::array<std::vector<Point>, 3>& edge_jumps);

  /// Ascending t: just before and after each jump that the nearest lines on either side let
  /// expect, and halfway between the chords of the edges' jumps, where there are several.
  std::vector<double> divide(double s);

  /// The jumps found on the line last divided, in any order.
  void record(std::vector<double> jumps);

 private:
  struct Chord {
    Point from;
    Point to;
  };
  struct Jumps {
    double s;
    std::vector<double> t;
  };

  void add_between_chords(std::vector<double>& ends) const;
  void add_around(const std::vector<double>& jumps, std::vector<double>& ends) const;

  std::vector<Chord> _chords;
  std::vector<Jumps> _lines;  ///< with a jump or more, by ascending s
  std::vector<double> _expected;
  double _s = 0;
  double _doubt = 1e-3;  ///< how wrong forecasts have been
};

}  // namespace anticrack::fem
