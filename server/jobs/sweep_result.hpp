// SPDX-License-Identifier: GPL-3.0-or-later
//
// The result of a sweep. Each chunk's columns go into the job's spool when it ends.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "contact/sweep_columns.hpp"
#include "jobs/live_job.hpp"
#include "records/block.hpp"

namespace anticrack::jobs {

/// Columns for `rows` rows on the job's mesh, still without answers.
contact::SweepColumns unsolved_rows(const LiveJob& job, std::size_t rows);

/// The rows of a chunk: the arrays of arrays::sweep_rows and sweep_matrices.
records::Block chunk_arrays(const contact::SweepColumns& columns);

/// Fills columns of that shape from the bytes of such a block. Throws errors::Error (storage) if
/// these are fewer or more.
void read_columns(std::span<const std::byte> bytes, contact::SweepColumns& columns);

/// The arrays of ReadResult for a sweep; null if no row has an answer. Rows without an answer have
/// the status `unsolved` and zeros. Throws errors::Error (storage).
std::shared_ptr<const records::BlockSource> sweep_result(const LiveJob& job,
                                                         contact::Status unsolved);

}  // namespace anticrack::jobs
