// SPDX-License-Identifier: GPL-3.0-or-later
//
// One watcher's way through a job's event log.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "anticrack/v1/solve.pb.h"
#include "jobs/event_log.hpp"
#include "rpc/backend.hpp"
#include "rpc/feed.hpp"
#include "rpc/watch_group.hpp"

namespace anticrack::rpc {

/// A cursor, no queue: what the watcher has not taken stays in the job's log, is sent in rounds
/// with the other watches of the job, and a watcher that falls behind its trimming ends with
/// OUT_OF_RANGE instead of a silent gap. Messages: the snapshot; then events in order, samples and
/// ends of load cases that follow each other in one, the samples packed as columns; last the end.
class WatchFeed final : public Feed<v1::WatchJobResponse> {
 public:
  /// Events a message: some 55 kB of samples. Larger ones were not faster (memory of that size goes
  /// back to the system and comes again with each), and every peer that does not read holds one.
  static constexpr std::size_t max_batch = 1024;

  /// `id` of the job; `after` as WatchJobRequest.after_sequence.
  /// Throws errors::Error: not_found, sequence_trimmed (trimmed already, or in the future).
  /// To be made and used where the store may be waited for.
  WatchFeed(const Backend& backend, WatchGroups& groups, std::string id, std::uint64_t after);
  ~WatchFeed() override;

  void start(std::function<void()> wake) override;
  Next next(v1::WatchJobResponse& response) override;
  bool ending() const noexcept override;
  std::uint64_t lag() const noexcept override;
  bool heartbeat(v1::WatchJobResponse& response) override;

 private:
  void fill_snapshot(v1::WatchJobResponse& response);
  jobs::NumberedBatch read();
  void fill(const jobs::ProgressEvents& progress, v1::WatchJobResponse& response);
  void fill(const jobs::PhaseEvent& phase, v1::WatchJobResponse& response);
  void fill(const jobs::RowsEvent& rows, v1::WatchJobResponse& response);
  static void fill(const jobs::StageEvent& stage, v1::WatchJobResponse& response);
  void fill(const jobs::EndEvent& end, v1::WatchJobResponse& response);

  const Backend _backend;
  const std::string _id;
  const std::shared_ptr<WatchGroup> _group;
  std::optional<WatchGroup::Wakes::iterator> _member;
  std::vector<std::string> _load_names;
  std::atomic<std::uint64_t> _cursor;  ///< written by the thread that drives the feed
  bool _from_earliest = false;         ///< nothing delivered yet, and no place asked for
  bool _snapshot_sent = false;
  bool _ended = false;
  v1::JobStatus::State _state = v1::JobStatus::STATE_UNSPECIFIED;
  std::string _detail;
};

}  // namespace anticrack::rpc
