// SPDX-License-Identifier: GPL-3.0-or-later
//
// The threads that solve.
#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <optional>
#include <string>
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
///
/// A step cannot be put down. Where all threads have been at one for EngineOptions::long_step, a
/// spare thread takes a turn for an owner, without names a mesh, that has no thread; the system
/// divides the processors. The first turn that ends then gives its thread up. Ends of stages
/// (stage_end.hpp), owners in turn, are no turns: they go on beside the threads that solve.
class SolverPool {
 public:
  /// Starts the threads, which are joined at the end: EngineCore::quitting must be set then. The
  /// core must outlive them.
  explicit SolverPool(EngineCore& core);
  SolverPool(const SolverPool&) = delete;
  SolverPool& operator=(const SolverPool&) = delete;

 private:
  using Lock = EngineCore::Lock;
  using Mesh = std::shared_ptr<MeshWork>;

  /// A thread's turn.
  struct Working {
    std::string mesh, owner;
    EngineCore::Clock::time_point begin, step;  ///< of the turn, of what it is at now
  };

  void work();
  std::optional<Turn> next_turn();
  /// There is always a thread that waits, to see that all others are at long steps.
  void keep_a_spare();
  void rest(Lock& lock);

  // Without the lock; a turn each:
  void iterate(const Mesh& mesh, Lane lane, Working& working);
  void solve_exactly(const Mesh& mesh, Working& working);
  void sweep(const Mesh& mesh, Working& working);
  // and its parts:
  void admit(const Mesh& mesh, Lane lane, std::shared_ptr<BlockRun>& block);
  std::vector<EndedCase> step(BlockRun& block);
  /// Units of the most urgent jobs, which are started where they were not. Counted in
  /// EngineCore::columns.
  std::vector<Task> take(const Mesh& mesh, Lane lane, int room, int max_starts);

  bool turn_is_over(const MeshWork& mesh, Lane lane, const Working& working) const;
  /// A load case waits that is more urgent than all of a block that has no place for it.
  bool overtaken(const MeshWork& mesh, Lane lane, const BlockRun& block) const;

  std::size_t threads() const noexcept;  ///< that solve, spare ones apart
  std::size_t idle() const noexcept;     ///< of them, those without a turn

  EngineCore& _core;
  std::list<Working> _working;
  int _resting = 0;
  int _at_stage_ends = 0;
  bool _watched = false;  ///< one of those that rest wakes up by itself
  std::list<std::jthread> _threads;
};

}  // namespace anticrack::jobs
