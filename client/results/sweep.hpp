// SPDX-License-Identifier: GPL-3.0-or-later
//
// Many load cases on one mesh, answered in columns: row k of every array is load case k.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "anticrack/v1/solve.pb.h"
#include "results/arrays.hpp"

namespace anticrack::results {

struct Sweep {
  std::vector<std::string> loads;       ///< names of the basis loads; empty for nodal forces
  std::vector<std::string> inclusions;  ///< names
  std::string source;                   ///< file of the coefficients or nodal forces
  std::string error;                    ///< error of the first row that failed
  v1::SweepAnswer answer;               ///< counts of rows by status, worst steps and residual
  /// tables::columns by their names. `status` has LoadCaseAnswer.Status; the numbers of a row are
  /// valid only if it converged. `kept` has the rows with traces, ascending, for each of which
  /// there is a load "row-17". `coefficients` are missing if unknown, as the server does not return
  /// them.
  Arrays columns;

  /// A column of numbers; empty if there is none.
  std::span<const double> numbers(std::string_view name) const {
    return entries_at<double>(columns, name);
  }
  /// The same of whole numbers.
  std::span<const std::int32_t> integers(std::string_view name) const {
    return entries_at<std::int32_t>(columns, name);
  }
  std::span<const std::int32_t> status() const { return integers("status"); }  ///< by row
  std::size_t rows() const { return status().size(); }                         ///< their number
  /// Number of tips, if their numbers were asked for.
  std::size_t tips() const { return rows() == 0 ? 0 : numbers("intensity").size() / rows(); }
  /// Whether a row converged, so that its numbers are valid.
  bool converged(std::size_t row) const {
    return status()[row] == v1::LoadCaseAnswer::STATUS_CONVERGED;
  }
};

/// Ranges over the converged rows.
struct SweepSummary {
  struct Range {
    double low = std::numeric_limits<double>::quiet_NaN();  ///< NaN if no row converged
    double high = std::numeric_limits<double>::quiet_NaN();
    bool nonzero() const noexcept { return low < 0 || high > 0; }
  };
  std::vector<Range> displacement;          ///< of A, one per inclusion
  std::vector<std::array<Range, 2>> slope;  ///< of Bx and By, one per inclusion
  Range contact_length, energy;
  /// Ranges of the membrane's exact A and energy: from the bounds of a row or, without bounds, from
  /// its value.
  std::vector<Range> displacement_bounds;
  Range energy_bounds;
  std::size_t bounded = 0;  ///< converged rows whose energy has bounds
  /// Over the bounded rows: the largest width of the energy's bounds relative to the energy, and
  /// half the largest width of the bounds of A over all inclusions; NaN if no row is bounded.
  double energy_width = std::numeric_limits<double>::quiet_NaN();
  double displacement_error = std::numeric_limits<double>::quiet_NaN();

  /// Whether the inclusion has a slope other than 0 in a converged row.
  bool tilted(std::size_t inclusion) const noexcept {
    return std::ranges::any_of(slope[inclusion], &Range::nonzero);
  }
  /// Whether any inclusion has a slope other than 0 in a converged row.
  bool tilted() const noexcept;
};

/// The ranges and the widths of the bounds over the converged rows. O(rows).
SweepSummary summary(const Sweep& sweep);

/// The name of a row's load: "row-17".
std::string row_name(std::int64_t row);

/// Describes the first invariant that does not hold (counts, bounds, enums, kept rows); empty if
/// all hold. O(rows).
std::string first_fault(const Sweep& sweep);

}  // namespace anticrack::results
