// SPDX-License-Identifier: GPL-3.0-or-later
//
// The threads on which jobs wait for their meshes.
#pragma once

#include <list>
#include <memory>
#include <string>
#include <thread>

#include "jobs/engine_core.hpp"

namespace anticrack::jobs {

/// Each waits for one mesh at a time, for all the jobs on it; there are as many as there ever were
/// meshes at a time, and one. A preparation that no job wants any
/// more is stopped; one that finds the memory held by others is tried again when the cache says.
class PreparationPool {
 public:
  /// Starts a thread; the core must outlive it.
  explicit PreparationPool(EngineCore& core);
  /// Joins the threads; EngineCore::quitting must be set and no job be live.
  ~PreparationPool();
  PreparationPool(const PreparationPool&) = delete;
  PreparationPool& operator=(const PreparationPool&) = delete;

 private:
  using Lock = EngineCore::Lock;
  using Mesh = std::shared_ptr<MeshWork>;

  void work();
  /// Another mesh may wait beside the one that is taken.
  void make_others_look();
  void prepare(Lock& lock, const Mesh& mesh);
  /// A phase of the mesh, to all the jobs that wait for it. Without the lock.
  void tell(MeshWork& mesh, const std::string& phase);
  /// How far the mesher is, to those who watch them.
  void tell(MeshWork& mesh, const store::MeshProgress& progress);

  EngineCore& _core;
  int _idle = 0;
  std::list<std::thread> _threads;
};

}  // namespace anticrack::jobs
