// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/preparation.hpp"

#include <fmt/core.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <new>
#include <system_error>
#include <utility>

#include "meshes/mesh_index.hpp"
#include "meshes/size_class.hpp"
#include "meshes/triangulation.hpp"
#include "stop/stop.hpp"

namespace anticrack::meshes {

namespace {

using errors::Error;
using errors::Reason;
using store::MeshRecord;
using store::MeshState;
using Steady = std::chrono::steady_clock;

/// The calling thread, and what it starts, gets a third of the share of others where both want a
/// processor, and all that they leave. For good: nobody needs a privilege to give way, but one to
/// take it back.
void give_way() {
  constexpr int niceness = 5;
  const auto self = static_cast<id_t>(::gettid());
  if (::getpriority(PRIO_PROCESS, self) < niceness) ::setpriority(PRIO_PROCESS, self, niceness);
}

constexpr int runs_at_once = 2;  // of one class of sizes
constexpr std::size_t records_a_page = 100;

/// 0 if it cannot be computed; Algorithm 2 reports why.
double theta_star(const operators::MeshOperator& mesh_operator) {
  try {
    return mesh_operator.theta_star();
  } catch (const Error&) {
    return 0;
  }
}

Error nobody_wants(const std::string& mesh) {
  return {Reason::cancelled, "no job wants meshes/" + mesh + " any more"};
}

}  // namespace

Preparation::Preparation(CatalogueOptions options, store::Store& store,
                         operators::OperatorCache& cache)
    : _options(std::move(options)), _store(store), _cache(cache) {
  recover();
  const auto held = lock();
  _threads.emplace_back([this] { work(); });
}

Preparation::~Preparation() {
  std::list<std::jthread> threads;
  {
    const auto held = lock();
    _stopping.request_stop();
    for (const RunPtr& run : _under_way) run->stop.request_stop();
    threads = std::move(_threads);
  }
}

void Preparation::recover() {
  std::vector<std::string> unmeshed;
  store::Page page{{}, records_a_page, {}};
  for (;;) {
    const std::vector<MeshRecord> records = _store.meshes(page);
    for (const MeshRecord& record : records) {
      LiveMesh& mesh = _index.add(record);
      if (mesh.stage == Stage::pending) {
        mesh.size_class = size_class(expected_triangles(record, _options, _store));
        unmeshed.push_back(record.id);
      }
    }
    if (records.size() < records_a_page) break;
    page.after = records.back().id;
  }
  // Those for jobs begin when their jobs ask for them.
  for (auto id = unmeshed.rbegin(); id != unmeshed.rend(); ++id)
    if (!_index.known(*id).for_job) begin(*id, true);
}

MeshRecord Preparation::stored(const std::string& id) const {
  std::optional<MeshRecord> record = _store.mesh(id);
  if (!record) throw Error(Reason::not_found, "there is no meshes/" + id + ": create it first");
  return std::move(*record);
}

MeshRecord Preparation::record(const std::string& id) {
  for (;;) {
    Lock held = lock();
    const std::uint64_t version = _index.known(id).version;
    held.unlock();
    MeshRecord record = stored(id);
    held.lock();
    // Otherwise the record may be older than the index.
    if (const LiveMesh& mesh = _index.known(id); mesh.version == version)
      return seen(mesh, std::move(record), _cache.contains(mesh.sha256));
  }
}

LiveMesh* Preparation::settled(Lock& lock, const std::string& id) {
  LiveMesh* mesh = nullptr;
  _changed.wait(lock, [&] {
    mesh = _index.find(id);
    return mesh == nullptr ||
           !(mesh->claimed || (mesh->run && (mesh->run->ending || mesh->run->writing)));
  });
  return mesh;
}

Preparation::RunPtr Preparation::begin(const std::string& id, bool background) {
  LiveMesh& mesh = _index.known(id);
  const bool pending = mesh.stage == Stage::pending;
  if (!mesh.run) {
    mesh.run = std::make_shared<Run>(Run{id, mesh.size_class, mesh.owner});
    mesh.run->phase = pending ? MeshState::pending : MeshState::factorizing;
    _queue.push_back(mesh.run);
    _changed.notify_all();
  }
  mesh.run->background = mesh.run->background || background;
  mesh.run->measures = mesh.run->measures || background || pending;
  return mesh.run;
}

Preparation::RunPtr Preparation::give_up(LiveMesh& mesh, const Error& why) {
  const RunPtr run = std::exchange(mesh.run, nullptr);
  if (!run) return nullptr;
  _queue.remove(run);
  run->error = why;
  _changed.notify_all();
  return run;
}

void Preparation::let_go(const std::string& id) {
  RunPtr run;
  {
    const auto held = lock();
    LiveMesh* mesh = _index.find(id);
    if (mesh == nullptr || !mesh->run || !mesh->users.expired()) return;
    const Run& its = *mesh->run;
    if (its.background || its.waiters > 0 || its.result || its.ending || its.writing) return;
    run = give_up(*mesh, nobody_wants(id));
  }
  run->stop.request_stop();
}

std::size_t Preparation::queued() const {
  return static_cast<std::size_t>(
      std::count_if(_queue.begin(), _queue.end(), [](const RunPtr& run) { return run->measures; }));
}

void Preparation::await(Lock& lock, Run& run, bool joins, const PhaseListener& listener,
                        const std::stop_token& stop, const ProgressListener& progress) {
  const auto ended = [&] { return run.result || run.error; };
  std::optional<MeshState> reported;
  std::optional<store::MeshProgress> told;
  while (reported != run.phase || !ended()) {
    const MeshState phase = run.phase;
    if (reported == phase) {
      const auto farther = [&] { return phase == MeshState::meshing && run.progress != told; };
      if (!_changed.wait(lock, stop, [&] { return run.phase != phase || ended() || farther(); }))
        throw Error(Reason::cancelled, "stopped while waiting for meshes/" + run.id);
      if (run.phase == phase && !ended() && farther()) {
        told = run.progress;
        lock.unlock();
        if (progress) progress(*told);
        lock.lock();
      }
      continue;
    }
    reported = phase;
    if (joins && phase == MeshState::factorizing && !ended()) _cache.count_join();
    lock.unlock();
    listener(phase);
    lock.lock();
  }
}

Preparation::Operator Preparation::prepare(const std::string& id, const PhaseListener& listener,
                                           const std::stop_token& stop,
                                           const ProgressListener& progress) {
  Lock held = lock();
  settled(held, id);
  LiveMesh& mesh = _index.known(id);
  if (mesh.stage == Stage::failed) throw Error(*mesh.error);
  if (mesh.stage == Stage::meshed && mesh.operators.bytes > 0 && (!mesh.run || mesh.run->visible)) {
    if (Operator ready = _cache.find(mesh.sha256, mesh.owner)) return ready;
  }
  const bool joins = mesh.run != nullptr;
  const RunPtr run = begin(id, false);
  ++run->waiters;
  try {
    await(held, *run, joins, listener, stop, progress);
  } catch (...) {
    if (!held) held.lock();
    const bool unwanted = leave(*run);
    held.unlock();
    if (unwanted) run->stop.request_stop();
    throw;
  }
  Operator result = run->result;
  run->visible = run->visible || result;
  leave(*run);
  if (!result) throw Error(*run->error);
  return result;
}

bool Preparation::leave(Run& run) {
  if (--run.waiters > 0) return false;
  LiveMesh* mesh = mesh_of(run);
  if (mesh == nullptr) {
    run.result.reset();  // the run is over; its result would pin the operators
    return false;
  }
  if (run.background || run.result || run.ending || run.writing) return false;
  _queue.remove(mesh->run);
  mesh->run.reset();
  _changed.notify_all();
  return true;
}

LiveMesh* Preparation::mesh_of(const Run& run) {
  LiveMesh* mesh = _index.find(run.id);
  return mesh != nullptr && mesh->run.get() == &run ? mesh : nullptr;
}

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
        // The existing threads take the waiting runs one after the other.
      }
    }
    held.unlock();
    perform(*run);
    held.lock();
    _under_way.remove(run);
    _changed.notify_all();
  }
}

bool Preparation::may_begin(const Run& run) const {
  int as_large = 0;
  bool own = false;
  for (const RunPtr& other : _under_way) {
    if (other->size_class != run.size_class) continue;
    ++as_large;
    own = own || other->owner == run.owner;
  }
  const bool newcomer = !run.owner.empty() && !own;
  return as_large < (newcomer ? 2 : 1) * runs_at_once;
}

Preparation::RunPtr Preparation::take() {
  auto best = _queue.end();
  std::pair<std::ptrdiff_t, std::uint64_t> best_rank;
  for (auto run = _queue.begin(); run != _queue.end(); ++run) {
    if (!may_begin(**run)) continue;
    const std::string& owner = (*run)->owner;
    const auto own = std::count_if(_under_way.begin(), _under_way.end(),
                                   [&](const RunPtr& other) { return other->owner == owner; });
    const auto started = _started.find(owner);
    const std::pair rank{own, started == _started.end() ? 0 : started->second};
    if (best == _queue.end() || rank < best_rank) {
      best = run;
      best_rank = rank;
    }
  }
  if (best == _queue.end()) return nullptr;
  _started[(*best)->owner] = ++_starts;
  _under_way.splice(_under_way.end(), _queue, best);
  return _under_way.back();
}

void Preparation::perform(Run& run) {
  try {
    factorize(run, run.phase == MeshState::pending ? triangulate(run) : nullptr);
  } catch (const Error& error) {
    fail(run, error);
  } catch (const std::bad_alloc&) {
    fail(run,
         run.phase == MeshState::factorizing
             ? Error(Reason::busy, "not enough memory for this mesh now")
                   .retry_after(operators::retry_delay)
             : Error(Reason::limit_exceeded, "not enough memory for this mesh: make it coarser"));
  } catch (const std::exception& error) {
    fail(run, Error(Reason::internal, std::string("preparing the mesh failed: ") + error.what()));
  }
}

std::shared_ptr<const mesh::Mesh> Preparation::triangulate(Run& run) {
  std::string twin;
  {
    const auto held = lock();
    run.phase = MeshState::meshing;
    twin = _index.twin(run.id);
    _changed.notify_all();
  }
  const MeshRecord record = stored(run.id);
  std::optional<Triangulation> made;
  if (!twin.empty()) {
    const stop::Scope scope(run.stop.get_token());
    made = copy_of(twin, record, _store);
  }
  const bool copied = made.has_value();
  if (!copied) {
    ++_meshings;
    made = meshes::triangulate(record, _options, _store, run.stop.get_token(),
                               [&](const store::MeshProgress& progress) {
                                 const auto held = lock();
                                 run.progress = progress;
                                 _changed.notify_all();
                               });
  }
  {
    auto held = lock();
    const LiveMesh* mesh = begin_writing(held, run);
    if (mesh == nullptr) throw Error(Reason::cancelled, "meshing was cancelled");
    made->record.for_job = mesh->for_job;
  }
  try {
    _store.put(made->record, *made->mesh);
  } catch (...) {
    end_writing(run);
    throw;
  }
  {
    const auto held = lock();
    LiveMesh& mesh = _index.known(run.id);
    mesh.stage = Stage::meshed;
    mesh.sha256 = made->record.sha256;
    mesh.size_class = size_class(made->record.triangle_count);
    mesh.refusals = 0;
    ++mesh.version;
    run.phase = MeshState::factorizing;
    run.progress.reset();
    run.writing = false;
    const bool wanted = run.background || run.waiters > 0 || !mesh.used || !mesh.users.expired();
    if (!wanted) give_up(mesh, nobody_wants(run.id));  // its last job ended while it was written
    _changed.notify_all();
  }
  if (!copied && _options.meshed) _options.meshed(made->record);
  return std::move(made->mesh);
}

/// Waiters get the operators before theta* is known: at a large interface it takes longer than all
/// the rest, and only Algorithm 2 and reports need it.
void Preparation::factorize(Run& run, std::shared_ptr<const mesh::Mesh> triangulation) {
  const auto start = Steady::now();
  Lock held = lock();
  LiveMesh* mesh = mesh_of(run);
  if (mesh == nullptr) return;
  const std::string sha256 = mesh->sha256, owner = mesh->owner;
  held.unlock();
  Operator result = _cache.find(sha256, owner);
  if (!result) {
    if (!triangulation) {
      const stop::Scope scope(run.stop.get_token());
      triangulation = _store.triangulation(sha256);
    }
    if (!triangulation) {
      throw Error(Reason::storage, fmt::format("the triangulation of meshes/{} is not in the data "
                                               "folder: delete the mesh and create it again",
                                               run.id));
    }
    result = _cache.acquire(sha256, std::move(triangulation), run.stop.get_token(), owner);
  }
  held.lock();
  mesh = mesh_of(run);
  if (mesh == nullptr) return;
  if (std::exchange(mesh->pin, false))
    _cache.pin(sha256);  // `result` keeps it from being evicted first
  mesh->operators.seconds = std::chrono::duration<double>(Steady::now() - start).count();
  const auto measure = [&](double theta) {
    mesh->operators.bytes = result->bytes();
    mesh->operators.theta_star = theta > 0 ? theta : mesh->operators.theta_star;
  };
  measure(result->known_theta_star());
  run.result = result;
  if (run.waiters > 0) {
    run.visible = true;
    run.ending = !run.measures;
    _changed.notify_all();
    record_outcome(held, run);
  }
  if (run.measures && !run.ending) {
    held.unlock();
    const double theta = [&] {
      const stop::Scope scope(run.stop.get_token());
      return theta_star(*result);
    }();
    held.lock();
    mesh = mesh_of(run);
    if (mesh == nullptr) return;
    measure(theta);
    result.reset();  // first, so that the operators can be evicted once they are announced
    if (run.waiters == 0) run.result.reset();
    run.visible = true;
    run.ending = true;
    record_outcome(held, run);
  }
  finish(run);
}

LiveMesh* Preparation::begin_writing(Lock& lock, Run& run) {
  LiveMesh* mesh = nullptr;
  _changed.wait(lock, [&] { return (mesh = mesh_of(run)) == nullptr || !mesh->claimed; });
  run.writing = mesh != nullptr;
  return mesh;
}

void Preparation::end_writing(Run& run) {
  const auto held = lock();
  run.writing = false;
  _changed.notify_all();
}

void Preparation::begin_due() {
  while (!_later.empty() && _later.begin()->first <= Steady::now()) {
    const std::string id = _later.extract(_later.begin()).mapped();
    const LiveMesh* mesh = _index.find(id);
    const bool waits = mesh != nullptr && mesh->stage == Stage::pending && !mesh->claimed;
    const bool wanted = waits && !(mesh->for_job && mesh->used && mesh->users.expired());
    if (wanted) begin(id, !mesh->for_job);
  }
}

/// Soon, and then more and more rarely, up to each half minute.
void Preparation::begin_later(LiveMesh& mesh, const std::string& id) {
  constexpr int most_doublings = 5;
  constexpr std::chrono::seconds first{1}, longest{30};
  const auto delay = std::min(first * (1 << std::min(mesh.refusals++, most_doublings)), longest);
  _later.emplace(Steady::now() + delay, id);
}

/// The measured values are valid even if the disk has no room for them.
void Preparation::record_outcome(Lock& lock, Run& run) {
  LiveMesh* const mesh = begin_writing(lock, run);
  if (mesh == nullptr) return;
  const Measured measured = mesh->operators;
  lock.unlock();
  try {
    MeshRecord record = stored(run.id);
    record.operator_bytes = measured.bytes;
    record.theta_star = measured.theta_star;
    record.factorize_seconds = measured.seconds;
    _store.put(record);
  } catch (const Error&) {
  }
  lock.lock();
  run.writing = false;
  ++mesh->version;
  _changed.notify_all();
}

void Preparation::fail(Run& run, Error error) {
  Lock held = lock();
  LiveMesh* mesh = begin_writing(held, run);
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
      // Not recorded: waiters get the error, and a later attempt fails again.
      failed.reset();
      error = meshed ? error : disk;
    }
  }
  held.lock();
  if (failed) {
    mesh->stage = Stage::failed;
    mesh->error = error;
  } else if (!meshed && error.reason() != Reason::cancelled) {
    begin_later(*mesh, run.id);
  }
  run.error = std::move(error);
  finish(run);
  held.unlock();
  if (failed && !meshed && _options.meshed) _options.meshed(*failed);
}

void Preparation::finish(Run& run) {
  if (LiveMesh* mesh = mesh_of(run)) {
    mesh->pin = false;
    ++mesh->version;
    if (run.waiters == 0) run.result.reset();
    mesh->run.reset();
  }
  _changed.notify_all();
}

}  // namespace anticrack::meshes
