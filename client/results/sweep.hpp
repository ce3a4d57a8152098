// SPDX-License-Identifier: GPL-3.0-or-later
//
// Many load cases on one mesh, answered in columns: row k of every array is load case k.
#pragma once

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

/// The least and the greatest of some numbers; NaN of none.
struct Range {
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
  bool nonzero() const noexcept { return low < 0 || high > 0; }
};

/// The range, over the converged rows, of the number at `place` of each row of a column; of 0 if
/// there is no such column. `exact`: the range of the membrane's exact numbers, from the bounds of
/// a row or, without bounds, from its number. O(rows).
Range range_of(const Sweep& sweep, const std::string& column, std::size_t place = 0,
               bool exact = false);

/// The range of Bx (`part` 0) or By of an inclusion.
inline Range slope_range(const Sweep& sweep, std::size_t inclusion, std::size_t part) {
  return range_of(sweep, "slope", 2 * inclusion + part);
}

/// How wide the bounds of the converged rows that have them are; NaN if none has.
struct Widths {
  std::size_t rows = 0;                                      ///< that have bounds of the energy
  double energy = std::numeric_limits<double>::quiet_NaN();  ///< the largest, relative
  double displacement = std::numeric_limits<double>::quiet_NaN();  ///< half the largest, of any A
};
/// The widths of a sweep. O(rows).
Widths widths_of(const Sweep& sweep);

/// The name of a row's load: "row-17".
std::string row_name(std::int64_t row);

/// Describes the first invariant that does not hold (counts, bounds, enums, kept rows); empty if
/// all hold. O(rows).
std::string first_fault(const Sweep& sweep);

}  // namespace anticrack::results
