// SPDX-License-Identifier: GPL-3.0-or-later
//
// The load cases of a sweep, read and checked before anything is submitted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <istream>
#include <string>
#include <vector>

#include "anticrack/v1/job.pb.h"
#include "cli/case.hpp"
#include "results/file.hpp"

namespace anticrack::cli {

/// The files as the user names them; exactly one of the two is given.
struct SweepFiles {
  std::string coefficients;  ///< FILE.csv or FILE.h5:/PATH; the default path is /coefficients
  std::string nodal;         ///< FILE.h5:/PATH
  std::string traces = "none";
  bool bounds = false;
  bool tips = false;
};

struct SweepInput : results::Matrix {
  SweepFiles files;

  /// Whether rows have f on the nodes; else coefficients of the loads.
  bool nodal() const noexcept { return !files.nodal.empty(); }
  /// Where the values come from.
  const std::string& source() const noexcept { return nodal() ? files.nodal : files.coefficients; }
  /// The size of the values in bytes.
  std::size_t bytes() const noexcept { return values.size() * sizeof(double); }
};

/// Most bytes of a matrix within the request; a larger one is uploaded.
inline constexpr std::size_t inline_matrix_bytes = std::size_t{1} << 20;

/// Removes the accuracy from the case, as a sweep has one mesh, and the coarse mesh with which only
/// the accuracy would begin. Returns false if there is no accuracy.
bool leave_out_accuracy(Case& the_case);

/// Reads the matrix and checks it against the case. Throws CaseError and results::Error, with
/// file, line and cure.
SweepInput read_sweep_input(const SweepFiles& files, const Case& the_case);

/// Makes the case's job a sweep, except the matrix. The server checks method and limits.
void make_sweep(const SweepInput& input, Case& the_case);

/// Throws CaseError unless there is a column for each node of the mesh.
void check_nodes(const SweepInput& input, std::uint64_t node_count);

/// The matrix of the job.
v1::Sweep::Matrix& matrix_of(const SweepInput& input, v1::JobSpec& spec);

/// "all", "none", or numbers from 0 and inclusive ranges, "0,10,20-30", in any order, possibly
/// overlapping. Returns each row once, ascending. Throws CaseError for anything else, and for a row
/// outside 0..rows. O(rows) if no range is there many times.
std::vector<std::uint32_t> select_rows(const std::string& text, std::size_t rows);

/// The load of each column by its name. Throws CaseError for a name that is no load of the case, or
/// is there twice; place(i) tells where name i is.
std::vector<std::size_t> loads_of_columns(const std::vector<std::string>& names,
                                          const std::vector<std::string>& loads,
                                          const std::function<std::string(std::size_t)>& place);

/// Comma-separated numbers, a line per row; separated by semicolons where the first line has one,
/// and then decimal commas are read, too. Blank lines and lines that begin with # are skipped.
/// The first line may name the loads, in any order; without it the columns follow `loads`. Quotes
/// around a field are removed. Returns (rows, loads) row-major, in the order of `loads`: at least
/// one row, all values finite. Throws CaseError with `source`, line, column, value and cure.
/// O(length).
std::vector<double> parse_coefficients(std::istream& text, const std::string& source,
                                       const std::vector<std::string>& loads);

/// The same for a file.
std::vector<double> read_coefficients(const std::filesystem::path& file,
                                      const std::vector<std::string>& loads);

}  // namespace anticrack::cli
