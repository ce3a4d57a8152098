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
/// takes up work that was put down there, or begins new work. A turn that has lasted
/// EngineOptions::turn ends as soon as something else waits, and its work is put down for any
/// thread to take up. A load case that is more urgent than those of a full block gets a block of
/// its own, and the blocks take turns. A thread takes no more than its share of the load cases that
/// wait on a lane; each idle thread has an equal share.
///
/// A step cannot be put down. If all threads have been in one step for EngineOptions::long_step, a
/// spare thread takes a turn for an owner (without authentication, a mesh) that has no thread, and
/// the system shares the processors among them. The thread of the first turn that ends then gives
/// way. Ends of stages (stage_end.hpp) are not turns: they run beside the threads that solve, and
/// owners take turns with them.
class SolverPool {
 public:
  /// Starts the threads. The destructor joins them; EngineCore::quitting must be set by then. The
  /// core must outlive them.
  explicit SolverPool(EngineCore& core);
  SolverPool(const SolverPool&) = delete;
  SolverPool& operator=(const SolverPool&) = delete;

 private:
  using Lock = EngineCore::Lock;
  using Mesh = std::shared_ptr<MeshWork>;

  /// The turn of a thread.
  struct Working {
    std::string mesh, owner;
    EngineCore::Clock::time_point begin, step;  ///< start of the turn, and of the present step
  };

  void work();
  std::optional<Turn> next_turn();
  /// Makes sure that some thread waits, to notice when all others are in long steps.
  void keep_a_spare();
  void rest(Lock& lock);

  // Without the lock; a turn each:
  void iterate(const Mesh& mesh, Lane lane, Working& working);
  void solve_exactly(const Mesh& mesh, Working& working);
  void sweep(const Mesh& mesh, Working& working);
  // and its parts:
  void admit(const Mesh& mesh, Lane lane, std::shared_ptr<BlockRun>& block);
  std::vector<EndedCase> step(BlockRun& block);
  /// Takes units of the most urgent jobs, and starts the jobs that were not started. Counts the
  /// units in EngineCore::columns.
  std::vector<Task> take(const Mesh& mesh, Lane lane, int room, int max_starts);

  bool turn_is_over(const MeshWork& mesh, Lane lane, const Working& working) const;
  /// Whether a load case waits that is more urgent than all those of a full block.
  bool overtaken(const MeshWork& mesh, Lane lane, const BlockRun& block) const;

  std::size_t threads() const noexcept;  ///< threads that solve, without the spare ones
  std::size_t idle() const noexcept;     ///< those of them that have no turn

  EngineCore& _core;
  std::list<Working> _working;
  int _resting = 0;
  int _at_stage_ends = 0;
  bool _watched = false;  ///< whether one of the resting threads wakes by itself
  std::list<std::jthread> _threads;
};

}  // namespace anticrack::jobs
