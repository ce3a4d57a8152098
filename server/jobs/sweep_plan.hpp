// SPDX-License-Identifier: GPL-3.0-or-later
//
// Divides a sweep into the pieces that solver threads take.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include "jobs/job_engine.hpp"
#include "jobs/sweep_check.hpp"

namespace anticrack::operators {
class MeshOperator;
}  // namespace anticrack::operators

namespace anticrack::jobs {

/// Known once the mesh is. A chunk is a run of rows that one thread solves in order, using only
/// these rows, so the numbers do not depend on which thread solves what.
struct SweepPlan {
  std::string matrix;  ///< path of its file
  std::uint64_t rows = 0;
  std::size_t columns = 0;
  std::size_t chunk_rows = 1;
  std::size_t portion_chunks = 0;  ///< chunks of a portion; 0: one server solves all of them
  std::uint64_t result_bytes = 0;  ///< of the result block, its arrays' alignment included

  /// The number of chunks; the last may have fewer rows.
  std::size_t chunks() const noexcept {
    return static_cast<std::size_t>((rows + chunk_rows - 1) / chunk_rows);
  }
  /// The first row of a chunk, index base 0.
  std::uint64_t first_row(std::size_t chunk) const noexcept { return chunk * chunk_rows; }
  /// The number of rows of a chunk.
  std::size_t rows_in(std::size_t chunk) const noexcept {
    return static_cast<std::size_t>(std::min<std::uint64_t>(chunk_rows, rows - first_row(chunk)));
  }
};

/// Rows of a chunk: as many as a thread solves in some milliseconds, which is long compared with
/// the lock and the event that a chunk costs, and short compared with a turn. Of many `rows`
/// combinations a chunk has more, up to some tenths of a second: the more rows there are to order
/// (contact::solving_order), the more alike neighbours are. `motions`: how many numbers give the
/// motions of the inclusions.
std::size_t chunk_rows(records::SweepSpec::Cases cases, std::uint64_t rows, std::size_t nodes,
                       std::size_t contacts, std::size_t motions);

/// How many consecutive chunks, of at most `chunk_bytes` of answers each, are a portion, where
/// several servers solve a sweep that counts as so many load cases in the queue (queued_cases). 0:
/// it has too few for another server to factorise the mesh for it, or portions would be too large.
std::size_t portion_chunks(std::uint64_t cases, std::size_t chunks, std::uint64_t chunk_bytes);

/// With bounds, rows are as slow as load cases, and a chunk has at most as many as
/// MeshOperator::estimate takes together. Throws errors::Error as rows_of does, and limit_exceeded
/// at matrix_field if the columns of the answers would be larger than a result may be.
SweepPlan plan_sweep(const records::JobSpec& spec, MatrixFile matrix,
                     const operators::MeshOperator& mesh_operator, const EngineOptions& options);

}  // namespace anticrack::jobs
