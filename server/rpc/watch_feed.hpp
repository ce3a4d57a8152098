// SPDX-License-Identifier: GPL-3.0-or-later
//
// One watcher's way through a job's event log.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "anticrack/v1/solve.pb.h"
#include "jobs/job_engine.hpp"
#include "rpc/feed.hpp"
#include "rpc/from_domain.hpp"

namespace anticrack::rpc {

/// A cursor, no queue: what the watcher has not taken stays in the job's log, and a watcher that
/// falls behind its trimming ends with OUT_OF_RANGE instead of a silent gap.
/// Messages: the snapshot; then events in order, consecutive samples packed; last the end.
class WatchFeed final : public Feed<v1::WatchJobResponse> {
 public:
  /// Samples a message: some 40 kB, and few enough writes for a fast job.
  static constexpr std::size_t max_batch = 512;

  /// `id` of the job; `after` as WatchJobRequest.after_sequence.
  /// Throws errors::Error: not_found, sequence_trimmed (trimmed already, or in the future).
  WatchFeed(const jobs::JobEngine& engine, const meshes::MeshCatalogue& catalogue, std::string id,
            std::uint64_t after);

  void start(std::function<void()> wake) override;
  Next next(v1::WatchJobResponse& response) override;
  bool ending() const noexcept override;
  bool heartbeat(v1::WatchJobResponse& response) override;

 private:
  void fill_snapshot(v1::WatchJobResponse& response);
  std::vector<jobs::NumberedEvent> read();
  /// Puts as many of `events` as fit together into `response` and moves the cursor behind them.
  void fill(const std::vector<jobs::NumberedEvent>& events, v1::WatchJobResponse& response);

  const jobs::JobEngine& _engine;
  const std::string _id;
  const std::shared_ptr<jobs::EventLog> _log;
  std::shared_ptr<jobs::EventLog::Listener> _listener;
  InterfaceNames _interfaces;
  const meshes::MeshCatalogue& _catalogue;
  std::vector<std::string> _load_names;
  std::uint64_t _cursor = 0;
  bool _from_earliest = false;  ///< nothing delivered yet, and no place asked for
  bool _snapshot_sent = false;
  bool _ended = false;
  v1::Job::State _state = v1::Job::STATE_UNSPECIFIED;
  std::string _detail;
};

/// Names of the interfaces of a mesh; empty where it is not known (any more) or not meshed.
InterfaceNames interface_names(const meshes::MeshCatalogue& catalogue, const std::string& mesh_id);

}  // namespace anticrack::rpc
