// SPDX-License-Identifier: GPL-3.0-or-later
//
// Many load cases on one mesh, answered in columns: row k of every array is load case k.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "anticrack/v1/solve.pb.h"

namespace anticrack::results {

struct Sweep {
  std::vector<std::string> loads;       ///< names of the basis loads; empty for nodal forces
  std::vector<std::string> inclusions;  ///< names
  std::string source;                   ///< file of the coefficients or nodal forces
  std::string error;                    ///< error of the first row that failed
  v1::SweepAnswer answer;               ///< counts of rows by status, worst steps and residual
  /// (rows, loads) row-major: row k is the load sum_j c_kj loads[j]. Empty for nodal forces, and if
  /// unknown, as the server does not return coefficients.
  std::vector<double> coefficients;

  /// (rows) LoadCaseAnswer.Status; the numbers of a row are valid only if it converged.
  std::vector<std::int32_t> status;
  std::vector<std::int32_t> steps;  ///< (rows) steps of the active set
  std::vector<double> energy;       ///< (rows) Pi(u)
  /// (rows) bounds of the membrane's exact Pi, NaN if a row has none; empty if not asked for.
  std::vector<double> energy_lower, energy_upper;
  std::vector<double> energy_mesh;     ///< (rows) Pi of u on the mesh; empty as the bounds
  std::vector<double> contact_length;  ///< (rows) over all cracks and delaminated parts
  std::vector<double> kkt;             ///< (rows) largest relative residual
  std::vector<double> displacement;    ///< (rows, inclusions) row-major: A of equation (5)
  std::vector<double> displacement_lower, displacement_upper;  ///< bounds of A, as of the energy
  std::vector<double> displacement_mesh;    ///< A of u on the mesh; empty as the bounds
  std::vector<double> slope;                ///< (rows, inclusions, 2) Bx, By; empty if none tilts
  std::vector<std::uint8_t> contact;        ///< (rows, contacts) row-major: 1 closed under pressure
  std::vector<std::int32_t> contact_nodes;  ///< (contacts, 2): interface, and its node
  /// (rows, tips) row-major, NaN where a tip has none; empty if not asked for.
  std::vector<double> intensity, energy_release_rate, energy_release_rate_spread;

  /// Rows whose traces were kept, ascending: Result::loads has one load for each, "row-17".
  std::vector<std::int32_t> kept;

  /// Whether a row converged, so that its numbers are valid.
  bool converged(std::size_t row) const noexcept {
    return status[row] == v1::LoadCaseAnswer::STATUS_CONVERGED;
  }
  /// Number of rows, and of crack nodes.
  std::size_t rows() const noexcept { return status.size(); }
  std::size_t contacts() const noexcept { return contact_nodes.size() / 2; }
  std::size_t tips() const noexcept { return rows() == 0 ? 0 : intensity.size() / rows(); }
  /// The length that a word of a shape means: "rows", "contacts", "inclusions", "tips", ...
  std::size_t extent(std::string_view word) const noexcept;
  /// Bx (part 0) or By (part 1) of an inclusion in a row; 0 if no inclusion tilts.
  double slope_at(std::size_t row, std::size_t inclusion, std::size_t part) const noexcept {
    return slope.empty() ? 0 : slope[(row * inclusions.size() + inclusion) * 2 + part];
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

/// Describes the first invariant that does not hold (lengths, counts, enums, kept rows); empty if
/// all hold. O(rows).
std::string first_fault(const Sweep& sweep);

}  // namespace anticrack::results
