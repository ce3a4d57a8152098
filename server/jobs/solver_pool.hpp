// SPDX-License-Identifier: GPL-3.0-or-later
//
// The threads that solve.
#pragma once

#include <cstddef>
#include <memory>
#include <thread>
#include <vector>

#include "jobs/engine_core.hpp"

namespace anticrack::jobs {

/// Each thread takes turns over the meshes and lanes that have work (schedule.hpp). In a turn it
/// takes up what was put down there, or begins anew; a turn that has lasted EngineOptions::turn
/// ends as soon as something else waits, and what is under way is put down for any thread to take
/// up. A load case more urgent than those of a full block has a block of its own, in turn with
/// that. Of the load cases that wait on a lane a thread takes no more than its share: the other
/// shares are those of the threads that are idle.
class SolverPool {
 public:
  /// Starts the threads; the core must outlive them.
  explicit SolverPool(EngineCore& core);
  /// Joins the threads; EngineCore::quitting must be set.
  ~SolverPool();
  SolverPool(const SolverPool&) = delete;
  SolverPool& operator=(const SolverPool&) = delete;

 private:
  using Lock = EngineCore::Lock;
  using Mesh = std::shared_ptr<MeshWork>;

  void work();
  void look_for(Lock& lock, const Mesh& mesh);
  void iterate(Lock& lock, const Mesh& mesh, Lane lane);
  void solve_exactly(Lock& lock, const Mesh& mesh);
  void sweep(Lock& lock, const Mesh& mesh);

  void admit(Lock& lock, const Mesh& mesh, Lane lane, std::shared_ptr<BlockRun>& block);
  std::vector<EndedCase> step(Lock& lock, BlockRun& block);

  /// Units of the most urgent jobs, which are started where they were not.
  std::vector<Task> take(Lock& lock, const Mesh& mesh, Lane lane, int room, int max_starts);
  bool turn_is_over(const MeshWork& mesh, Lane lane, EngineCore::Clock::time_point begin) const;
  /// A load case waits that is more urgent than all of a block that has no place for it.
  bool overtaken(const MeshWork& mesh, Lane lane, const BlockRun& block) const;

  EngineCore& _core;
  std::vector<std::thread> _threads;
};

}  // namespace anticrack::jobs
