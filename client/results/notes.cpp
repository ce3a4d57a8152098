// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/result.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>

namespace anticrack::results {
namespace {

/// A parabola of this height has a slope of about 0.4; the equation neglects its square, 0.16.
constexpr double largest_part = 0.1;

struct Largest {
  double u = 0;
  std::string_view load;  ///< empty for a sweep

  void take(std::span<const double> values, std::string_view of) {
    for (const double value : values)
      if (std::abs(value) > u) *this = {std::abs(value), of};
  }
};

Largest largest_of(const Result& result) {
  Largest largest;
  for (const Load& load : result.loads) {
    for (const v1::InclusionAnswer& inclusion : load.answer.inclusions())
      largest.take(std::array{inclusion.displacement()}, load.name());
    const std::string at = load_path(load.name());
    for (auto array = result.arrays.lower_bound(at);
         array != result.arrays.end() && array->first.starts_with(at); ++array)
      for (const char* name : {"/u", "/u_minus", "/u_plus"})
        if (array->first.ends_with(name)) largest.take(array->second.as<double>(), load.name());
  }
  if (result.sweep) {
    for (std::size_t i = 0; i < result.sweep->inclusions.size(); ++i) {
      const Range range = range_of(*result.sweep, "displacement", i);
      largest.take(std::array{range.low, range.high}, "");
    }
  }
  return largest;
}

double smaller_side(std::span<const double> nodes) {
  double side = std::numeric_limits<double>::infinity();
  for (const std::size_t axis : {0, 1}) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t i = axis; i < nodes.size(); i += 2) {
      low = std::min(low, nodes[i]);
      high = std::max(high, nodes[i]);
    }
    side = std::min(side, high - low);
  }
  return side;
}

}  // namespace

std::vector<std::string> notes_on(const Result& result) {
  std::vector<std::string> notes;
  const std::string &length = result.units.length(), &force = result.units.force();
  if (length.empty() != force.empty()) {
    const std::string missing = length.empty() ? "length" : "force";
    notes.push_back("[units] gives no " + missing +
                    ", so energies and tensions have no unit here; write both length and force");
  }
  if (length.empty()) return notes;  // u may have another unit than x and y
  const Largest largest = largest_of(result);
  const double side = smaller_side(entries_at<double>(result.arrays, "mesh/nodes"));
  if (!(largest.u > largest_part * side)) return notes;
  const std::string load = largest.load.empty() ? "" : fmt::format(" in load \"{}\"", largest.load);
  notes.push_back(fmt::format(
      "u reaches {:.3g} {}{}, and the smaller side of the sheet is {:.3g} {}: the equation is that "
      "of small slopes, u up to about a tenth of the side. u is proportional to the load and to "
      "1/tension: look for a factor in them",
      largest.u, length, load, side, length));
  return notes;
}

}  // namespace anticrack::results
