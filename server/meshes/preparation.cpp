// SPDX-License-Identifier: GPL-3.0-or-later
//
// Begins runs, retries them and gives them up, and tells those who wait.
#include "meshes/preparation.hpp"

#include <algorithm>
#include <utility>

#include "meshes/size_class.hpp"
#include "meshes/triangulation.hpp"

namespace anticrack::meshes {

namespace {

using errors::Error;
using errors::Reason;
using records::MeshRecord;
using records::MeshState;
using Phase = MeshNews::Phase;

constexpr std::size_t records_a_page = 100;

Phase phase_of(MeshState state) {
  return state == MeshState::pending   ? Phase::queued
         : state == MeshState::meshing ? Phase::meshing
                                       : Phase::factorising;
}

Error not_there(const std::string& mesh) {
  return {Reason::not_found, "there is no meshes/" + mesh + ": create it first"};
}

}  // namespace

MeshWaits::~MeshWaits() {
  Preparation::Lock held = _preparation.lock();
  std::vector<std::uint64_t> own;
  for (const auto& [number, wait] : _preparation._waits)
    if (wait->whose == this) own.push_back(number);
  for (const std::uint64_t number : own) end_held(number);
  _preparation._delivered.wait(held, [&] { return _preparation._telling != this; });
}

std::uint64_t MeshWaits::begin(const std::string& id, records::Priority priority,
                               std::chrono::steady_clock::time_point since) {
  const auto held = _preparation.lock();
  const std::uint64_t number = ++_preparation._last_wait;
  const auto wait = std::make_shared<Wait>(Wait{number, this, id, priority, since});
  _preparation._waits.emplace(number, wait);
  LiveMesh* mesh = _preparation._index.find(id);
  if (mesh == nullptr || mesh->stage == Stage::absent) {
    _preparation.tell(wait, {.phase = Phase::failed, .error = not_there(id)});
    return number;
  }
  wait->joined = mesh->run && !mesh->run->ending;
  mesh->waits.push_back(wait);
  _preparation.serve(id);
  return number;
}

void MeshWaits::join(std::uint64_t number, records::Priority priority,
                     std::chrono::steady_clock::time_point since) {
  const auto held = _preparation.lock();
  const LiveMesh* mesh = _preparation._index.find(_preparation._waits.at(number)->mesh);
  if (mesh != nullptr && mesh->run) _preparation._queue.await(mesh->run->place, priority, since);
}

void MeshWaits::end(std::uint64_t number) {
  const auto held = _preparation.lock();
  end_held(number);
}

void MeshWaits::end_held(std::uint64_t number) {
  const auto ended = _preparation._waits.extract(number);
  if (ended.empty()) return;
  Wait& wait = *ended.mapped();
  wait.over = true;
  if (wait.place > 0) {
    _preparation._queue.let_go(wait.place);
    _preparation.notify();
  } else if (LiveMesh* mesh = _preparation._index.find(wait.mesh)) {
    if (std::erase(mesh->waits, ended.mapped()) > 0) _preparation.give_up_unwanted(*mesh);
  }
}

Preparation::Preparation(CatalogueOptions options, store::Store& store,
                         operators::OperatorCache& cache)
    : _options(std::move(options)), _store(store), _cache(cache) {
  recover();
  const auto held = lock();
  _threads.emplace_back([this] { deliver(); });
  _threads.emplace_back([this] { work(); });
}

Preparation::~Preparation() {
  std::list<std::jthread> threads;
  std::map<std::uint64_t, RunPtr> runs;
  {
    const auto held = lock();
    _stopping.request_stop();
    threads = std::move(_threads);
    runs = _under_way;
  }
  _to_deliver.notify_one();
  for (const auto& [number, run] : runs) run->stop.request_stop();
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
  // Meshes for jobs begin when their jobs ask for them.
  for (auto id = unmeshed.rbegin(); id != unmeshed.rend(); ++id)
    if (!_index.known(*id).for_job) begin(*id, true);
}

MeshRecord Preparation::stored(const std::string& id) const {
  std::optional<MeshRecord> record = _store.mesh(id);
  if (!record) throw not_there(id);
  return std::move(*record);
}

void Preparation::look_again(const std::string& id) {
  if (_store.queue() == nullptr) return;
  const std::optional<MeshRecord> record = _store.mesh(id);
  const auto held = lock();
  LiveMesh* mesh = _index.find(id);
  if (mesh != nullptr && (mesh->claimed || mesh->run || !mesh->waits.empty())) return;
  if (!record) {
    if (mesh != nullptr && mesh->users.expired()) _index.remove(id);
    return;
  }
  const bool failed = record->state == MeshState::failed;
  if (mesh != nullptr && mesh->sha256 == record->sha256 && (mesh->stage == Stage::failed) == failed)
    return;
  ++_index.add(*record).version;
}

MeshRecord Preparation::record(const std::string& id) {
  look_again(id);
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

Preparation::Lock Preparation::lock_settled(const std::string& id) {
  Lock held = lock();
  _changed.wait(held, [&] {
    const LiveMesh* mesh = _index.find(id);
    return mesh == nullptr ||
           !(mesh->claimed || (mesh->run && (mesh->run->ending || mesh->run->writing)));
  });
  return held;
}

Run& Preparation::begin(const std::string& id, bool background) {
  LiveMesh& mesh = _index.known(id);
  const bool pending = mesh.stage == Stage::pending;
  if (!mesh.run) {
    const bool awaited = !mesh.waits.empty();
    const std::uint64_t place = _queue.add(
        mesh.owner, mesh.size_class, awaited ? mesh.waits[0]->priority : records::Priority::normal,
        awaited ? mesh.waits[0]->since : Steady::now());
    mesh.run = std::make_shared<Run>(Run{id, place});
    mesh.run->phase = pending ? MeshState::pending : MeshState::factorizing;
    _queued.emplace(place, mesh.run);
    _changed.notify_all();
  }
  mesh.run->background = mesh.run->background || background;
  return *mesh.run;
}

void Preparation::serve(const std::string& id) {
  LiveMesh* mesh = _index.find(id);
  if (mesh == nullptr || mesh->waits.empty() || mesh->claimed) return;
  if (mesh->stage == Stage::failed) return fail_waits(*mesh, *mesh->error);
  const bool measured = mesh->stage == Stage::meshed && mesh->operators.bytes > 0;
  if (measured && (!mesh->run || mesh->run->visible))
    if (const Operator ready = _cache.find(mesh->sha256, mesh->owner))
      return hand_over(*mesh, ready, 0);
  if (mesh->run && mesh->run->ending) return;  // the run serves them when it has ended
  const Run& run = begin(id, false);
  for (const auto& wait : mesh->waits) _queue.await(run.place, wait->priority, wait->since);
  tell_phase(*mesh, phase_of(run.phase));
}

Preparation::RunPtr Preparation::give_up(LiveMesh& mesh) {
  RunPtr run = std::exchange(mesh.run, nullptr);
  if (!run) return nullptr;
  _queue.remove(run->place);
  _queued.erase(run->place);
  _changed.notify_all();
  return run;
}

void Preparation::give_up_unwanted(LiveMesh& mesh) {
  if (!mesh.run || !mesh.waits.empty()) return;
  const Run& run = *mesh.run;
  if (run.background || run.ending || run.writing) return;
  _unwanted.push_back(give_up(mesh));
  _to_deliver.notify_one();
}

void Preparation::let_go(const std::string& id) {
  const auto held = lock();
  LiveMesh* mesh = _index.find(id);
  if (mesh != nullptr && mesh->users.expired()) give_up_unwanted(*mesh);
}

std::size_t Preparation::queued() const {
  return static_cast<std::size_t>(std::ranges::count_if(_queued, [](const auto& queued) {
    return queued.second->background || queued.second->phase == MeshState::pending;
  }));
}

LiveMesh* Preparation::mesh_of(const Run& run) {
  LiveMesh* mesh = _index.find(run.id);
  return mesh != nullptr && mesh->run.get() == &run ? mesh : nullptr;
}

void Preparation::tell(const std::shared_ptr<Wait>& wait, MeshNews news) {
  news.wait = wait->number;
  news.mesh = wait->mesh;
  wait->told = news.phase;
  _news.emplace_back(wait, std::move(news));
  _to_deliver.notify_one();
}

void Preparation::tell_phase(LiveMesh& mesh, Phase phase) {
  for (const auto& wait : mesh.waits) {
    // A mesh that waits for memory is tried every second, perhaps for hours: this is told once.
    if (wait->told == phase || wait->told == Phase::waits_for_memory) continue;
    if (phase == Phase::factorising && std::exchange(wait->joined, false)) _cache.count_join();
    tell(wait, {.phase = phase});
  }
}

void Preparation::hand_over(LiveMesh& mesh, const Operator& ready, std::uint64_t place) {
  for (const auto& wait : std::exchange(mesh.waits, {})) {
    wait->place = place;
    if (place > 0) _queue.hold(place);
    tell(wait, {.phase = Phase::ready, .mesh_operator = ready});
  }
}

void Preparation::fail_waits(LiveMesh& mesh, const Error& why) {
  for (const auto& wait : std::exchange(mesh.waits, {}))
    tell(wait, {.phase = Phase::failed, .error = why});
}

void Preparation::deliver() {
  Lock held = lock();
  for (;;) {
    _to_deliver.wait(
        held, [&] { return !_news.empty() || !_unwanted.empty() || _stopping.stop_requested(); });
    if (const std::vector<RunPtr> unwanted = std::exchange(_unwanted, {}); !unwanted.empty()) {
      held.unlock();
      for (const RunPtr& run : unwanted) run->stop.request_stop();
      held.lock();
    } else if (!_news.empty()) {
      const auto [wait, news] = std::move(_news.front());
      _news.pop_front();
      if (wait->over) continue;
      _telling = wait->whose;
      held.unlock();
      wait->whose->_tell(news);
      held.lock();
      _telling = nullptr;
      _delivered.notify_all();
    } else {
      return;
    }
  }
}

void Preparation::begin_due() {
  while (!_later.empty() && _later.begin()->first <= Steady::now()) {
    const std::string id = _later.extract(_later.begin()).mapped();
    const LiveMesh* mesh = _index.find(id);
    const bool waits = mesh != nullptr && mesh->stage == Stage::pending && !mesh->claimed;
    const bool wanted = waits && !(mesh->for_job && mesh->used && mesh->users.expired());
    if (wanted) begin(id, !mesh->for_job);
    serve(id);
  }
}

/// Schedules another try: soon at first, then more and more rarely, at last every half minute.
void Preparation::begin_later(LiveMesh& mesh, const std::string& id) {
  constexpr int most_doublings = 5;
  constexpr std::chrono::seconds first{1}, longest{30};
  const auto delay = std::min(first * (1 << std::min(mesh.refusals++, most_doublings)), longest);
  _later.emplace(Steady::now() + delay, id);
}

}  // namespace anticrack::meshes
