// SPDX-License-Identifier: GPL-3.0-or-later
//
// What one of several servers does of a job (spreading.hpp).
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "records/job_record.hpp"
#include "store/queue.hpp"

namespace anticrack::jobs {

/// Portions are named by number, units by index: of a chunk, or of a position, which is a portion.
/// The engine's mutex guards it.
struct LiveSpread {
  bool ready = false;                           ///< the job has started, so its units can be solved
  std::vector<std::size_t> units{};             ///< to solve here, in this order
  std::map<std::uint64_t, std::size_t> open{};  ///< portions here: units that are left
  std::map<std::size_t, records::SweepRecord> sums{};  ///< of chunks that are not in the store yet
  std::map<std::uint64_t, std::string> requests{};     ///< of the positions here
  std::map<std::uint64_t, std::string> answers{};      ///< to positions, packed
  std::set<std::uint64_t> unwritten{};                 ///< portions solved here, not in the store
  std::chrono::steady_clock::time_point begun{};       ///< when it was made ready
  std::chrono::steady_clock::time_point looked{};      ///< when the store was last asked for news
  std::chrono::steady_clock::time_point served{};      ///< when a thread was last seen on a unit

  // Of the server that runs the job:
  std::vector<store::Portion> to_offer{};   ///< portions that the store does not have yet
  std::set<std::uint64_t> missing{};        ///< portions whose answers are not here
  std::vector<std::int64_t> to_withdraw{};  ///< portions that nobody else is to solve
  std::size_t idle = 0;                     ///< threads that wait for positions
};

}  // namespace anticrack::jobs
