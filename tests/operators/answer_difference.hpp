// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "contact/answer.hpp"
#include "support/multipliers.hpp"

namespace anticrack::operators {

/// Largest difference of two lists of values, and the largest of the second.
struct Gap {
  double difference = 0;
  double scale = 0;

  void add(double a, double b) {
    difference = std::isfinite(a) && std::isfinite(b) ? std::max(difference, std::abs(a - b))
                                                      : std::numeric_limits<double>::infinity();
    scale = std::max(scale, std::abs(b));
  }
  void add(const std::vector<double>& a, const std::vector<double>& b) {
    if (a.size() != b.size()) {
      difference = std::numeric_limits<double>::infinity();
      return;
    }
    for (std::size_t i = 0; i < a.size(); ++i) {
      add(a[i], b[i]);
    }
  }
  double relative() const { return difference == 0 ? 0 : difference / scale; }
};

/// Largest relative difference of the numbers of two answers: displacements (traces, fields, A),
/// A's scale being theirs; pressure; energy. Infinite where they are not of the same shape.
inline double difference(const contact::Answer& a, const contact::Answer& b) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  if (a.traces.size() != b.traces.size() || a.fields.size() != b.fields.size() ||
      a.inclusions.size() != b.inclusions.size()) {
    return infinite;
  }
  Gap u, pressure, energy;
  for (std::size_t c = 0; c < a.traces.size(); ++c) {
    u.add(a.traces[c].u_minus, b.traces[c].u_minus);
    u.add(a.traces[c].u_plus, b.traces[c].u_plus);
    pressure.add(testing::multipliers(a.traces[c]), testing::multipliers(b.traces[c]));
  }
  for (std::size_t s = 0; s < a.fields.size(); ++s) {
    u.add(a.fields[s].u, b.fields[s].u);
  }
  for (std::size_t j = 0; j < a.inclusions.size(); ++j) {
    u.add(a.inclusions[j].displacement, b.inclusions[j].displacement);
  }
  energy.add(a.energy, b.energy);
  return std::max({u.relative(), pressure.relative(), energy.relative()});
}

}  // namespace anticrack::operators
