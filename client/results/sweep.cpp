// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/sweep.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace anticrack::results {
namespace {

void widen(SweepSummary::Range& range, double value) {
  range.low = std::fmin(range.low, value);  // fmin ignores NaN
  range.high = std::fmax(range.high, value);
}

/// A column with its bounds, if it has them.
struct Bounded {
  std::span<const double> values, lower, upper;

  Bounded(const Sweep& sweep, const std::string& name)
      : values(sweep.numbers(name)),
        lower(sweep.numbers(name + "_lower")),
        upper(sweep.numbers(name + "_upper")) {}

  bool has(std::size_t place) const { return !lower.empty() && std::isfinite(lower[place]); }
  /// Widens the range to the bounds of an entry, or to its value if it has no bounds.
  void widen_range(SweepSummary::Range& range, std::size_t place) const {
    widen(range, has(place) ? lower[place] : values[place]);
    widen(range, has(place) ? upper[place] : values[place]);
  }
};

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

bool SweepSummary::tilted() const noexcept {
  for (std::size_t i = 0; i < slope.size(); ++i)
    if (tilted(i)) return true;
  return false;
}

SweepSummary summary(const Sweep& sweep) {
  SweepSummary result;
  const std::size_t inclusions = sweep.inclusions.size();
  result.displacement.resize(inclusions);
  result.displacement_bounds.resize(inclusions);
  result.slope.resize(inclusions);
  const Bounded energy(sweep, "energy"), displacement(sweep, "displacement");
  const auto status = sweep.status();
  const auto length = sweep.numbers("contact_length"), slope = sweep.numbers("slope");
  for (std::size_t row = 0; row < status.size(); ++row) {
    if (status[row] != v1::LoadCaseAnswer::STATUS_CONVERGED) continue;
    widen(result.energy, energy.values[row]);
    energy.widen_range(result.energy_bounds, row);
    widen(result.contact_length, length[row]);
    const bool bounded = energy.has(row);
    if (bounded) {
      ++result.bounded;
      const double width = energy.upper[row] - energy.lower[row];
      result.energy_width =
          std::fmax(result.energy_width, width > 0 ? width / std::abs(energy.values[row]) : 0);
    }
    for (std::size_t i = 0; i < inclusions; ++i) {
      const std::size_t place = row * inclusions + i;
      widen(result.displacement[i], displacement.values[place]);
      displacement.widen_range(result.displacement_bounds[i], place);
      for (const std::size_t part : {0U, 1U})
        widen(result.slope[i][part], slope.empty() ? 0 : slope[2 * place + part]);
      if (bounded)
        result.displacement_error =
            std::fmax(result.displacement_error,
                      0.5 * (displacement.upper[place] - displacement.lower[place]));
    }
  }
  return result;
}

std::string row_name(std::int64_t row) { return fmt::format("row-{}", row); }

std::string first_fault(const Sweep& sweep) {
  std::string fault = counts_fault(sweep);
  if (fault.empty()) fault = bounds_fault(sweep);
  return fault.empty() ? range_fault(sweep) : fault;
}

}  // namespace anticrack::results
