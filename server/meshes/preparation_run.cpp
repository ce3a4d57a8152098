// SPDX-License-Identifier: GPL-3.0-or-later
//
// The work of a run on its thread: the mesher, the factors, theta*, and the record.
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <new>
#include <system_error>
#include <utility>

#include "base/at_once.hpp"
#include "meshes/preparation.hpp"
#include "meshes/size_class.hpp"
#include "meshes/summary.hpp"
#include "meshes/triangulation.hpp"
#include "stop/stop.hpp"

namespace anticrack::meshes {

namespace {

using errors::Error;
using errors::Reason;
using records::MeshRecord;
using records::MeshState;
using Phase = MeshNews::Phase;

constexpr std::chrono::milliseconds shortest_retry{100};

/// Gives the calling thread, and those it starts, a third of the share of other threads when both
/// want a processor, and all the time that the others leave. This cannot be undone: a thread needs
/// no privilege to give way, but one to take it back.
void give_way() {
  constexpr int niceness = 5;
  const auto self = static_cast<id_t>(::gettid());
  if (::getpriority(PRIO_PROCESS, self) < niceness) ::setpriority(PRIO_PROCESS, self, niceness);
}

}  // namespace

void Preparation::work() {
  give_way();
  const std::stop_token stop = _stopping.get_token();
  Lock held = lock();
  for (;;) {
    RunPtr run;
    ++_idle;
    while (!stop.stop_requested() && !(run = take())) {
      const auto first_due = [&] {
        return _later.empty() ? Steady::time_point::max() : _later.begin()->first;
      };
      const auto due = first_due();
      const auto awake = [&] {
        return stop.stop_requested() || (run = take()) || first_due() != due;
      };
      if (_later.empty())
        _changed.wait(held, stop, awake);
      else
        _changed.wait_until(held, stop, due, awake);
      if (run) break;
      begin_due();
    }
    --_idle;
    if (!run) return;
    if (_idle == 0) {
      try {
        _threads.emplace_back([this] { work(); });
      } catch (const std::system_error&) {
        // Then the existing threads take the waiting runs one after the other.
      }
    }
    held.unlock();
    perform(*run);
    held.lock();
    _under_way.erase(run->place);
    _queue.done(run->place);
    _changed.notify_all();
  }
}

Preparation::RunPtr Preparation::take() {
  const auto place = _queue.next(Steady::now());
  if (!place) return nullptr;
  return _under_way.insert(_queued.extract(*place)).position->second;
}

void Preparation::perform(Run& run) {
  try {
    std::optional<Triangulation> made;
    if (run.phase == MeshState::pending) made = triangulate(run);
    factorize(run, made ? &*made : nullptr);
  } catch (const Error& error) {
    fail(run, error);
  } catch (const std::bad_alloc&) {
    fail(run,
         run.phase == MeshState::factorizing
             ? Error(Reason::busy, "not enough memory for this mesh now")
                   .retry_after(operators::retry_delay)
             : Error(Reason::limit_exceeded, "not enough memory for this mesh: make it coarser"));
  } catch (const std::exception& error) {
    fail(run, Error(Reason::internal, "preparing the mesh failed: {}", error.what()));
  }
}

Triangulation Preparation::triangulate(Run& run) {
  std::string twin;
  {
    const auto held = lock();
    run.phase = MeshState::meshing;
    twin = _index.twin(run.id);
    if (LiveMesh* mesh = mesh_of(run)) tell_phase(*mesh, Phase::meshing);
  }
  const MeshRecord record = stored(run.id);
  std::optional<Triangulation> made;
  if (!record.sha256.empty()) {  // another server has made it meanwhile
    if (auto there = _store.triangulation(record.sha256)) made = {std::move(there), record};
  } else if (!twin.empty()) {
    const stop::Scope scope(run.stop.get_token());
    made = copy_of(twin, record, _store);
  }
  if (!made) {
    ++_meshings;
    made = meshes::triangulate(record, _options, _store, run.stop.get_token(),
                               [&](const records::MeshProgress& progress) {
                                 const auto held = lock();
                                 run.progress = progress;
                                 LiveMesh* mesh = mesh_of(run);
                                 if (mesh == nullptr) return;
                                 for (const auto& wait : mesh->waits)
                                   tell(wait, {.phase = Phase::meshing, .progress = progress});
                               });
  }
  return std::move(*made);
}

void Preparation::keep(Run& run, Triangulation& made) {
  const bool is_new = made.record.triangle_count == 0;  // a copy has its summary
  if (is_new) {
    const stop::Scope scope(run.stop.get_token());
    summarize(*made.mesh, made.record);
  }
  {
    const auto [held, mesh] = lock_to_write(run);
    if (mesh == nullptr) throw Error(Reason::cancelled, "meshing was cancelled");
    made.record.for_job = mesh->for_job;
  }
  try {
    _store.put(made.record, *made.mesh);
  } catch (...) {
    end_writing(run);
    throw;
  }
  {
    const auto held = lock();
    LiveMesh& mesh = _index.known(run.id);
    mesh.stage = Stage::meshed;
    mesh.sha256 = made.record.sha256;
    mesh.size_class = size_class(made.record.triangle_count);
    mesh.refusals = 0;
    ++mesh.version;
    run.phase = MeshState::factorizing;
    run.progress.reset();
    run.writing = false;
    tell_phase(mesh, Phase::factorising);
    // The last job of the mesh may have ended while the record was written.
    if (mesh.used && mesh.users.expired()) give_up_unwanted(mesh);
    _changed.notify_all();
  }
  if (is_new && _options.meshed) _options.meshed(made.record);
}

Preparation::Operator Preparation::operators_of(const Run& run, const std::string& sha256,
                                                const std::string& owner,
                                                std::shared_ptr<const mesh::Mesh> triangulation) {
  if (Operator ready = _cache.find(sha256, owner)) return ready;
  if (!triangulation) {
    const stop::Scope scope(run.stop.get_token());
    triangulation = _store.triangulation(sha256);
  }
  if (!triangulation) {
    throw Error(Reason::storage,
                "the triangulation of meshes/{} is not in the data "
                "folder: delete the mesh and create it again",
                run.id);
  }
  return _cache.acquire(sha256, std::move(triangulation), run.stop.get_token(), owner);
}

void Preparation::factorize(Run& run, Triangulation* made) {
  Lock held = lock();
  LiveMesh* mesh = mesh_of(run);
  if (mesh == nullptr) return;
  const std::string sha256 = made != nullptr ? made->record.sha256 : mesh->sha256,
                    owner = mesh->owner;
  held.unlock();
  Operator result;
  double seconds = 0;
  const auto acquire = [&] {
    const auto start = Steady::now();
    result = operators_of(run, sha256, owner, made != nullptr ? made->mesh : nullptr);
    seconds = std::chrono::duration<double>(Steady::now() - start).count();
  };
  // A new mesh is summarised and stored by one thread while another factorises: the first steps of
  // either take one. It is stored, too, if there is no memory for its operators.
  if (made == nullptr)
    acquire();
  else
    base::at_once(
        2, 2, [&] { return [&](std::size_t part) { part == 0 ? keep(run, *made) : acquire(); }; });
  held.lock();
  mesh = mesh_of(run);
  if (mesh == nullptr) return;
  if (std::exchange(mesh->pin, false))
    _cache.pin(sha256);  // `result` keeps it from being evicted first
  mesh->operators = {result->bytes(), seconds};
  run.visible = true;
  run.ending = true;
  if (!mesh->waits.empty()) hand_over(*mesh, result, run.place);
  result.reset();  // before they are announced, so that the operators can be evicted then
  held.unlock();
  record_outcome(run);
  held.lock();
  finish(run);
  serve(run.id);  // waits that came too late for the result
}

std::pair<Preparation::Lock, LiveMesh*> Preparation::lock_to_write(Run& run) {
  Lock held = lock();
  LiveMesh* mesh = nullptr;
  _changed.wait(held, [&] { return (mesh = mesh_of(run)) == nullptr || !mesh->claimed; });
  run.writing = mesh != nullptr;
  return {std::move(held), mesh};
}

void Preparation::end_writing(Run& run) {
  const auto held = lock();
  run.writing = false;
  _changed.notify_all();
}

/// The measured values are valid even if the disk has no room for them.
void Preparation::record_outcome(Run& run) {
  auto [held, mesh] = lock_to_write(run);
  if (mesh == nullptr) return;
  const Measured measured = mesh->operators;
  held.unlock();
  try {
    MeshRecord record = stored(run.id);
    record.operator_bytes = measured.bytes;
    record.factorize_seconds = measured.seconds;
    _store.put(record);
  } catch (const Error&) {
  }
  held.lock();
  run.writing = false;
  ++mesh->version;
  _changed.notify_all();
}

void Preparation::fail(Run& run, Error error) {
  if (error.reason() == Reason::storage && error.retry_delay().count() > 0)  // out of reach
    error = Error(Reason::busy, "{}", error.what()).retry_after(error.retry_delay());
  auto [held, mesh] = lock_to_write(run);
  if (mesh == nullptr) return;
  run.writing = false;
  run.ending = true;
  const bool meshed = mesh->stage == Stage::meshed;
  held.unlock();
  std::optional<MeshRecord> failed;
  if (lasting(error)) {
    try {
      failed = stored(run.id);
      failed->state = MeshState::failed;
      failed->error = error;
      _store.put(*failed);
    } catch (const Error& disk) {
      // The failure is not recorded: waiters get the error, and a later attempt fails again.
      failed.reset();
      error = meshed ? error : disk;
    }
  }
  held.lock();
  if (failed) {
    mesh->stage = Stage::failed;
    mesh->error = error;
  } else if (error.reason() == Reason::busy && !mesh->waits.empty()) {
    tell_phase(*mesh, Phase::waits_for_memory);
    _later.emplace(Steady::now() + std::max(shortest_retry, error.retry_delay()), run.id);
  } else if (!meshed && error.reason() != Reason::cancelled) {
    begin_later(*mesh, run.id);
  }
  if (error.reason() != Reason::busy) fail_waits(*mesh, error);
  finish(run);
  held.unlock();
  if (failed && !meshed && _options.meshed) _options.meshed(*failed);
}

void Preparation::finish(Run& run) {
  if (LiveMesh* mesh = mesh_of(run)) {
    mesh->pin = false;
    ++mesh->version;
    mesh->run.reset();
  }
  _changed.notify_all();
}

}  // namespace anticrack::meshes
