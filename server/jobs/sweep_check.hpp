// SPDX-License-Identifier: GPL-3.0-or-later
//
// The checks of a sweep before it is solved.
#pragma once

#include <cstdint>
#include <string>

#include "jobs/job_engine.hpp"
#include "store/store.hpp"

namespace anticrack::jobs {

/// The field of the matrix: "sweep.coefficients" or "sweep.nodal_forces".
const char* matrix_field(const records::SweepSpec& sweep);

/// The part of `check` about the sweep, which the job must have: throws errors::Error
/// (invalid_argument, limit_exceeded) at "load_cases", "solver.uzawa", "outputs", "sweep.bounds",
/// "sweep.traces" or "sweep.traces[i]". Does not check the matrix.
void check_sweep(const records::JobSpec& spec, const EngineOptions& options);

/// The upload that holds a sweep's matrix.
struct MatrixFile {
  std::string path;
  std::uint64_t values = 0;
};

/// Finds the matrix. Throws errors::Error at matrix_field: not_found if the store has no such
/// upload of this owner, invalid_argument if it is not an array.
MatrixFile find_matrix(const records::SweepSpec& sweep, const store::Store& store,
                       const std::string& owner);

/// The number of rows of a matrix with `values` values. Throws errors::Error: invalid_argument at
/// matrix_field if the rows are not a whole number, and at "sweep.traces[i]" for a row that does
/// not exist; limit_exceeded at matrix_field.
std::uint64_t rows_of(const records::SweepSpec& sweep, std::uint64_t values, std::uint64_t columns,
                      std::uint64_t max_rows);

/// How many load cases a job counts in the queue (jobs/admission.hpp). Rows of a sweep are cheaper:
/// 256 combinations, or a megabyte of nodal forces, count as one; with bounds a 32nd of that.
std::uint64_t queued_cases(const records::JobSpec& spec, const store::Store& store,
                           const std::string& owner);
/// The same for a sweep whose matrix has `values` values.
std::uint64_t queued_cases(const records::JobSpec& spec, std::uint64_t values);

}  // namespace anticrack::jobs
