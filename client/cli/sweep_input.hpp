// SPDX-License-Identifier: GPL-3.0-or-later
//
// The load cases of a sweep, read and checked before anything is submitted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "anticrack/v1/server.pb.h"
#include "anticrack/v1/solve.pb.h"
#include "cli/case.hpp"

namespace anticrack::cli {

/// As a person names them; exactly one of the two files is given.
struct SweepFiles {
  std::string coefficients;  ///< FILE.csv or FILE.h5:/PATH, without a path /coefficients
  std::string nodal;         ///< FILE.h5:/PATH
  std::string traces = "none";
  bool bounds = false;
};

struct SweepInput {
  bool nodal = false;          ///< rows of f on the nodes; else of coefficients of the loads
  std::string source;          ///< where they are from
  std::string traces;          ///< rows whose traces to keep, not looked at yet
  bool bounds = false;         ///< asked for
  std::vector<double> values;  ///< (rows, columns) row-major
  std::size_t rows = 0;
  std::size_t columns = 0;

  /// Of the values.
  std::size_t bytes() const noexcept { return values.size() * sizeof(double); }
};

/// What is sent within the request; more goes as an upload.
inline constexpr std::size_t inline_matrix_bytes = std::size_t{1} << 20;

/// A sweep has one mesh: takes the accuracy out of the case, and the coarse mesh that only it would
/// begin on. False where there is none.
bool leave_out_accuracy(Case& the_case);

/// Reads the matrix and checks it against the case. Throws CaseError and results::Error, with
/// file, line and cure.
SweepInput read_sweep_input(const SweepFiles& files, const Case& the_case);

/// Makes the case's job a sweep: all of it but the matrix. Checks against what the server allows;
/// throws CaseError with the cure.
void make_sweep(const SweepInput& input, const v1::ServerLimits& limits, Case& the_case);

/// Throws CaseError unless there is a column for each node of the mesh.
void check_nodes(const SweepInput& input, std::uint64_t node_count);

/// Where the job keeps the matrix.
v1::Sweep::Matrix& matrix_of(const SweepInput& input, v1::JobSpec& spec);

/// "all", "none", or numbers from 0 and inclusive ranges, "0,10,20-30", in any order, possibly
/// overlapping. Returns each row once, ascending. Throws CaseError for anything else, for a
/// row outside 0..rows, and for more than `most` rows. O(rows returned).
std::vector<std::uint32_t> select_rows(const std::string& text, std::uint64_t rows,
                                       std::uint64_t most);

}  // namespace anticrack::cli
