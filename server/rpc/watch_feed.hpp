// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reads a job's event log for one watcher.
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
#include "jobs/event_codec.hpp"
#include "jobs/event_log.hpp"
#include "rpc/backend.hpp"
#include "rpc/feed.hpp"
#include "rpc/watch_group.hpp"

namespace anticrack::rpc {

/// Has a cursor but no queue: events that the watcher has not taken stay in the job's log and are
/// sent in rounds with the other watches of the job. A watcher that falls behind the trimmed part
/// of the log ends with OUT_OF_RANGE instead of a silent gap. Messages: the snapshot; then events
/// in order, with consecutive samples and ends of load cases in one message, the samples packed as
/// columns; last the end.
class WatchFeed final : public Feed<v1::WatchJobResponse> {
 public:
  /// Most events in a message: some 55 kB of samples. Larger messages were not faster (memory of
  /// that size is returned to the system and taken again for each), and every peer that does not
  /// read holds one.
  static constexpr std::size_t max_batch = 1024;

  /// `id`: of the job; `after`: as WatchJobRequest.after_sequence. Throws errors::Error: not_found,
  /// sequence_trimmed (trimmed already, or in the future). To be made and used on a thread that may
  /// wait for the store.
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
  void fill(const jobs::EndEvent& end, v1::WatchJobResponse& response);
  template <class Event>
  void fill(const Event& event, v1::WatchJobResponse& response) {
    jobs::write(event, response);
  }

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
