// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/sweep.hpp"

#include <fmt/core.h>

#include <cmath>

namespace anticrack::results {
namespace {

std::string counts_fault(const Sweep& sweep) {
  const v1::SweepAnswer& answer = sweep.answer;
  std::uint64_t left = sweep.rows();
  bool fits = answer.rows() == left;
  for (const std::uint64_t count : {answer.converged(), answer.not_converged(), answer.failed()}) {
    fits = fits && count <= left;
    left -= count;
  }
  return fits ? "" : fmt::format("sweep counts other rows than its {}", sweep.rows());
}

/// Checks that the sweep has all bounds, with the values on the mesh, or none.
std::string bounds_fault(const Sweep& sweep) {
  const std::size_t rows = sweep.numbers("energy_lower").size();
  bool whole = true;
  for (const std::string end : {"_lower", "_upper", "_mesh"})
    whole = whole && sweep.numbers("energy" + end).size() == rows &&
            sweep.numbers("displacement" + end).size() == rows * sweep.inclusions.size();
  return whole ? "" : "sweep has some of its bounds without the others";
}

std::string range_fault(const Sweep& sweep) {
  const auto status = sweep.status(), kept = sweep.integers("kept");
  for (std::size_t i = 0; i < status.size(); ++i)
    if (!v1::LoadCaseAnswer::Status_IsValid(status[i]))
      return fmt::format("sweep.status[{}] is {}, no status", i, status[i]);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const std::int32_t row = kept[i];
    if (row < 0 || static_cast<std::size_t>(row) >= status.size() ||
        (i > 0 && row <= kept[i - 1])) {
      return fmt::format("sweep.kept[{}] is {}, out of order or no row of the sweep", i, row);
    }
  }
  return {};
}

}  // namespace

Range range_of(const Sweep& sweep, const std::string& column, std::size_t place, bool exact) {
  const auto values = sweep.numbers(column), lower = sweep.numbers(column + "_lower"),
             upper = sweep.numbers(column + "_upper");
  Range range;
  for (std::size_t row = 0; row < sweep.rows(); ++row) {
    if (!sweep.converged(row)) continue;
    const std::size_t at = row * (values.size() / sweep.rows()) + place;
    const bool bounded = exact && !lower.empty() && std::isfinite(lower[at]);
    const double value = values.empty() ? 0 : values[at];
    range.low = std::fmin(range.low, bounded ? lower[at] : value);  // fmin ignores NaN
    range.high = std::fmax(range.high, bounded ? upper[at] : value);
  }
  return range;
}

Widths widths_of(const Sweep& sweep) {
  Widths widths;
  const auto energy = sweep.numbers("energy"), lower = sweep.numbers("energy_lower"),
             upper = sweep.numbers("energy_upper"), a_lower = sweep.numbers("displacement_lower"),
             a_upper = sweep.numbers("displacement_upper");
  const std::size_t inclusions = sweep.inclusions.size();
  for (std::size_t row = 0; row < lower.size(); ++row) {
    if (!sweep.converged(row) || !std::isfinite(lower[row])) continue;
    ++widths.rows;
    const double width = upper[row] - lower[row];
    widths.energy = std::fmax(widths.energy, width > 0 ? width / std::abs(energy[row]) : 0);
    for (std::size_t at = row * inclusions; at < (row + 1) * inclusions; ++at)
      widths.displacement = std::fmax(widths.displacement, 0.5 * (a_upper[at] - a_lower[at]));
  }
  return widths;
}

std::string row_name(std::int64_t row) { return fmt::format("row-{}", row); }

std::string first_fault(const Sweep& sweep) {
  std::string fault = counts_fault(sweep);
  if (fault.empty()) fault = bounds_fault(sweep);
  return fault.empty() ? range_fault(sweep) : fault;
}

}  // namespace anticrack::results
