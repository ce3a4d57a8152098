// SPDX-License-Identifier: GPL-3.0-or-later
//
// The whole answer to a run, for the result file and tables: the API's messages together with the
// arrays of the server's blocks, which tables.hpp describes.
//
// The membrane problem, its notation and equation numbers: Rudoy & Shcherbakov (2016). Index base
// 0. Lengths, displacements and forces are in the units of the case (dimensionless in the paper);
// times are in seconds. [u] = u+ - u-; the plus side lies on the left of an interface.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "anticrack/v1/mesh.pb.h"
#include "anticrack/v1/solve.pb.h"
#include "output/file.hpp"
#include "results/arrays.hpp"
#include "results/sweep.hpp"

namespace anticrack::results {

/// A result that cannot be written, read or assembled.
using output::Error;

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

struct Load {
  /// The name is unique and matches [A-Za-z0-9][A-Za-z0-9_. -]{0,63}. Numbers that the method does
  /// not compute are NaN or not set.
  v1::LoadCaseAnswer answer;
  /// Stages of a job with an accuracy, each on a finer mesh than the stage before and with the
  /// answer to this load only.
  std::vector<v1::Stage> stages;

  const std::string& name() const noexcept { return answer.name(); }
  /// Whether the answer has numbers: the load is `converged` or `not_converged`.
  bool has_answer() const noexcept {
    return answer.status() == v1::LoadCaseAnswer::STATUS_CONVERGED ||
           answer.status() == v1::LoadCaseAnswer::STATUS_NOT_CONVERGED;
  }
};

/// Where the arrays of a load are: "loads/NAME/".
std::string load_path(const std::string& name);

/// The name of a LoadCaseAnswer.Status in files: "not_converged".
std::string status_name(int status);

/// The largest relative residual; NaN if one of the residuals is NaN or none is known.
double largest_kkt(const v1::LoadCaseAnswer& answer) noexcept;

/// The unit of a quantity by its dimension in F (force) and L (length): "F/L^2" gives "N/mm^2".
/// Any other text, as "s", is a unit already. Returns "-" for an empty dimension, and if the case
/// does not name the unit of the length or the force.
std::string unit_of(const v1::Units& units, std::string_view dimension);
/// The unit behind a number, " mm"; empty instead of " -".
std::string unit_behind(const v1::Units& units, std::string_view dimension);

/// Returns "x [mm]", or the name alone without a unit.
std::string labelled(const std::string& name, const v1::Units& units, std::string_view dimension);

struct Result {
  std::string title;
  std::string case_text;  ///< the TOML as run, overrides applied
  std::string client_version;
  std::string server_version;
  std::string job_name;      ///< "jobs/ID"
  std::string not_reached;   ///< accuracy that was not reached, what stopped the job, the cure
  double total_seconds = 0;  ///< how long the user waited
  v1::Units units;
  v1::Solver solver;           ///< of all loads; what was not asked for has the API's default
  v1::Mesh mesh;               ///< without the definition and the interfaces' segments
  std::vector<Load> loads;     ///< if a sweep: its kept rows, without history
  std::optional<Sweep> sweep;  ///< set if the job is a sweep
  /// Those of tables.hpp but a sweep's; what subdomains have in common for all loads is in
  /// fields/D.
  Arrays arrays;
};

/// Solve time of all load cases, or of the sweep [s].
double solve_seconds(const Result& result);

/// Describes the first invariant of what this program looks at that does not hold (names, enums,
/// rows of a sweep): "sweep.status[3] is 9, no status"; empty if all hold. Arrays have been checked
/// where they come from. O(size).
std::string first_fault(const Result& result);

/// Writes a value, the middle of its bounds, and how far they are from it: "0.1038 +- 0.0010". The
/// distance has two digits, or one at 1e-6 of the value if it is smaller than that, and is rounded
/// so that the printed interval contains the bounds. Large or small numbers are
/// "(1.038 +- 0.010)e-5". Returns "-" if a bound is not finite. Python's text.interval writes the
/// same.
std::string interval(double value, double lower, double upper);

/// What a reader should know before believing the answers: that one of the units is missing; if
/// the case gives a unit of length, that u exceeds a tenth of the sheet's smaller side, as the
/// equation holds for small slopes. Empty if there is nothing to say.
std::vector<std::string> notes_on(const Result& result);

}  // namespace anticrack::results
