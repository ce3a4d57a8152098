// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/sweep.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "results/tables.hpp"

namespace anticrack::results {
namespace {

void widen(SweepSummary::Range& range, double value) {
  range.low = std::fmin(range.low, value);  // fmin ignores NaN
  range.high = std::fmax(range.high, value);
}

/// Widens the range to the bounds of an entry, or to its value if it has no bounds.
void widen(SweepSummary::Range& range, const std::vector<double>& values,
           const std::vector<double>& lower, const std::vector<double>& upper, std::size_t place) {
  const bool bounded = !lower.empty() && std::isfinite(lower[place]);
  widen(range, bounded ? lower[place] : values[place]);
  widen(range, bounded ? upper[place] : values[place]);
}

void add_bounds(const Sweep& sweep, std::size_t row, SweepSummary& result) {
  if (sweep.energy_lower.empty() || !std::isfinite(sweep.energy_lower[row])) return;
  ++result.bounded;
  const double width = sweep.energy_upper[row] - sweep.energy_lower[row];
  result.energy_width =
      std::fmax(result.energy_width, width > 0 ? width / std::abs(sweep.energy[row]) : 0);
  const std::size_t inclusions = sweep.inclusions.size();
  for (std::size_t i = row * inclusions; i < (row + 1) * inclusions; ++i)
    result.displacement_error =
        std::fmax(result.displacement_error,
                  0.5 * (sweep.displacement_upper[i] - sweep.displacement_lower[i]));
}

std::string length_fault(const Sweep& sweep) {
  std::string fault;
  arrays::for_each(
      [&](const auto& row) {
        const std::size_t have = std::invoke(row.member, sweep).size();
        if (!fault.empty() || (have == 0 && row.optional)) return;
        const std::size_t columns = arrays::columns_of(row.shape);
        const std::size_t want =
            sweep.extent(row.shape.substr(0, row.shape.find(','))) *
            (columns == 0               ? 1
             : columns == arrays::named ? sweep.extent(arrays::second_of(row.shape))
                                        : columns) *
            arrays::depth_of(row.shape);
        if (have == want) return;
        fault = fmt::format("sweep.{} has {} entries instead of {}", row.name, have, want);
      },
      tables::sweep_arrays);
  return fault;
}

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
  const std::size_t rows = sweep.energy_lower.size(), inclusions = sweep.inclusions.size();
  const bool whole = sweep.energy_upper.size() == rows && sweep.energy_mesh.size() == rows &&
                     sweep.displacement_lower.size() == rows * inclusions &&
                     sweep.displacement_upper.size() == rows * inclusions &&
                     sweep.displacement_mesh.size() == rows * inclusions;
  return whole ? "" : "sweep has some of its bounds without the others";
}

std::string range_fault(const Sweep& sweep) {
  for (std::size_t i = 0; i < sweep.rows(); ++i)
    if (!v1::LoadCaseAnswer::Status_IsValid(sweep.status[i]))
      return fmt::format("sweep.status[{}] is {}, no status", i, sweep.status[i]);
  for (std::size_t i = 0; i < sweep.kept.size(); ++i) {
    const std::int32_t row = sweep.kept[i];
    if (row < 0 || static_cast<std::size_t>(row) >= sweep.rows() ||
        (i > 0 && row <= sweep.kept[i - 1])) {
      return fmt::format("sweep.kept[{}] is {}, out of order or no row of the sweep", i, row);
    }
  }
  return {};
}

}  // namespace

std::size_t Sweep::extent(std::string_view word) const noexcept {
  return word == "rows"         ? rows()
         : word == "contacts"   ? contacts()
         : word == "inclusions" ? inclusions.size()
         : word == "tips"       ? tips()
         : word == "loads"      ? loads.size()
                                : kept.size();
}

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
  for (std::size_t row = 0; row < sweep.rows(); ++row) {
    if (!sweep.converged(row)) continue;
    widen(result.energy, sweep.energy[row]);
    widen(result.energy_bounds, sweep.energy, sweep.energy_lower, sweep.energy_upper, row);
    add_bounds(sweep, row, result);
    widen(result.contact_length, sweep.contact_length[row]);
    for (std::size_t i = 0; i < inclusions; ++i) {
      const std::size_t place = row * inclusions + i;
      widen(result.displacement[i], sweep.displacement[place]);
      widen(result.displacement_bounds[i], sweep.displacement, sweep.displacement_lower,
            sweep.displacement_upper, place);
      for (const std::size_t part : {0U, 1U})
        widen(result.slope[i][part], sweep.slope_at(row, i, part));
    }
  }
  return result;
}

std::string row_name(std::int64_t row) { return fmt::format("row-{}", row); }

std::string first_fault(const Sweep& sweep) {
  std::string fault = length_fault(sweep);
  if (fault.empty()) fault = counts_fault(sweep);
  if (fault.empty()) fault = bounds_fault(sweep);
  return fault.empty() ? range_fault(sweep) : fault;
}

}  // namespace anticrack::results
