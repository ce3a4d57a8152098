// SPDX-License-Identifier: GPL-3.0-or-later
//
// What can be said of a sweep before it is solved.
#pragma once

#include <cstdint>
#include <string>

#include "jobs/job_engine.hpp"
#include "store/store.hpp"

namespace anticrack::jobs {

/// "sweep.coefficients" or "sweep.nodal_forces".
const char* matrix_field(const records::SweepSpec& sweep);

/// The part of `check` that is about the sweep, which the job has: throws errors::Error
/// (invalid_argument, limit_exceeded) at "load_cases", "solver.uzawa", "outputs", "sweep.bounds",
/// "sweep.traces" or "sweep.traces[i]". Says nothing of the matrix.
void check_sweep(const records::JobSpec& spec, const EngineOptions& options);

/// The upload that holds a sweep's matrix.
struct MatrixFile {
  std::string path;
  std::uint64_t values = 0;
};

/// Throws errors::Error at matrix_field: not_found where the store has no such upload of this
/// owner, invalid_argument where it is not an array.
MatrixFile find_matrix(const records::SweepSpec& sweep, const store::Store& store,
                       const std::string& owner);

/// Rows of a matrix of so many values and columns. Throws errors::Error: invalid_argument at
/// matrix_field where that is not a whole number of rows and at "sweep.traces[i]" for a row it does
/// not have, limit_exceeded at matrix_field.
std::uint64_t rows_of(const records::SweepSpec& sweep, std::uint64_t values, std::uint64_t columns,
                      std::uint64_t max_rows);

/// What a job counts in the queue (jobs/admission.hpp), in load cases. Rows of a sweep are cheaper:
/// 256 combinations, or a megabyte of nodal forces, are as one; with bounds a 32nd of that.
std::uint64_t queued_cases(const records::JobSpec& spec, const store::Store& store,
                           const std::string& owner);

}  // namespace anticrack::jobs
