// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/preparation.hpp"

#include <new>
#include <utility>

#include "meshes/lasting.hpp"
#include "meshes/triangulation.hpp"

namespace anticrack::meshes {

namespace {

using errors::Error;
using errors::Reason;
using store::MeshRecord;
using store::MeshState;

constexpr int thread_count = 2;  // so that one large mesh does not hold up the small ones
constexpr std::size_t records_a_page = 100;

}  // namespace

/// A call of prepare(): the mesh is not erased meanwhile, so that references to it stay good.
class Preparation::Visit {
 public:
  Visit(Preparation& host, const std::string& id) : _host(host) {
    const std::lock_guard lock(_host._mutex);
    _mesh = &_host._index.known(id);
    ++_mesh->waiting;
  }
  ~Visit() {
    const std::lock_guard lock(_host._mutex);
    --_mesh->waiting;
  }
  Visit(const Visit&) = delete;
  Visit& operator=(const Visit&) = delete;

  LiveMesh& mesh() const { return *_mesh; }

 private:
  Preparation& _host;
  LiveMesh* _mesh = nullptr;
};

Preparation::Preparation(CatalogueOptions options, store::Store& store,
                         operators::OperatorCache& cache)
    : _options(std::move(options)), _store(store), _cache(cache) {
  recover();
  for (int i = 0; i < thread_count; ++i) {
    _threads.emplace_back([this] { work(); });
  }
}

Preparation::~Preparation() {
  _stopping.request_stop();
  _threads.clear();  // joins
}

void Preparation::recover() {
  std::vector<std::string> unmeshed;
  store::Page page{{}, records_a_page, {}};
  for (;;) {
    const std::vector<MeshRecord> records = _store.meshes(page);
    for (const MeshRecord& record : records) {
      if (_index.add(record).stage == Stage::pending) {
        unmeshed.push_back(record.id);
      }
    }
    if (records.size() < records_a_page) {
      break;
    }
    page.after = records.back().id;
  }
  for (auto id = unmeshed.rbegin(); id != unmeshed.rend(); ++id) {
    _index.schedule(*id);
  }
}

MeshRecord Preparation::stored(const std::string& id) const {
  std::optional<MeshRecord> record = _store.mesh(id);
  if (!record) {
    throw Error(Reason::not_found, "there is no meshes/" + id + ": create it first");
  }
  return std::move(*record);
}

MeshRecord Preparation::record(const std::string& id) const {
  for (;;) {
    std::unique_lock lock(_mutex);
    const std::uint64_t version = _index.known(id).version;
    lock.unlock();
    MeshRecord record = stored(id);
    lock.lock();
    // Else the record may be older than what the index says.
    if (const LiveMesh& mesh = _index.known(id); mesh.version == version) {
      return seen(mesh, std::move(record), _cache.contains(mesh.sha256));
    }
  }
}

void Preparation::wait_for_claim(std::unique_lock<std::mutex>& lock, const std::string& id) {
  _changed.wait(lock, [&] {
    const LiveMesh* mesh = _index.find(id);
    return mesh == nullptr || !mesh->claimed;
  });
}

void Preparation::wait_for_end(std::unique_lock<std::mutex>& lock, const std::string& id) {
  _changed.wait(lock, [&] {
    const LiveMesh* mesh = _index.find(id);
    return mesh == nullptr || !mesh->running || !mesh->ending;
  });
}

Preparation::Meshed Preparation::triangulate(const std::string& id) {
  std::string twin;
  {
    const std::lock_guard lock(_mutex);
    LiveMesh& mesh = _index.known(id);
    mesh.meshing = true;
    twin = _index.twin(id);
    _changed.notify_all();
  }
  const MeshRecord record = stored(id);
  std::optional<Triangulation> made;
  if (!twin.empty()) {
    made = copy_of(twin, record, _store);
  }
  const bool copied = made.has_value();
  if (!copied) {
    ++_meshings;
    made = meshes::triangulate(record, _options, _store, _stopping.get_token());
  }
  _store.put(made->record, *made->mesh);
  std::uint64_t round = 0;
  {
    const std::lock_guard lock(_mutex);
    LiveMesh& mesh = _index.known(id);
    mesh.stage = Stage::meshed;
    mesh.sha256 = made->record.sha256;
    mesh.meshing = false;
    ++mesh.version;
    round = begin_factorizing(mesh);
    _changed.notify_all();
  }
  if (!copied && _options.meshed) {
    _options.meshed(made->record);
  }
  return {std::move(made->mesh), round};
}

void Preparation::prepare_in_background(const std::string& id) {
  Stage stage = Stage::absent;
  Meshed meshed;
  {
    const std::lock_guard lock(_mutex);
    LiveMesh& mesh = _index.known(id);
    stage = mesh.stage;
    if (stage == Stage::meshed) {
      meshed.round = begin_factorizing(mesh);
    }
  }
  if (stage == Stage::pending) {
    meshed = triangulate(id);
  }
  if (stage != Stage::failed) {
    factorize(id, meshed.round, std::move(meshed.mesh), false, _stopping.get_token());
  }
}

/// A run that ended before the mesh had a triangulation. (Of what comes later end_factorizing has
/// told.)
void Preparation::set_back(const std::string& id, Error error) {
  {
    const std::lock_guard lock(_mutex);
    if (_index.known(id).stage != Stage::pending) {
      return;
    }
  }
  std::optional<MeshRecord> failed;
  if (lasting(error)) {
    try {
      failed = stored(id);
      failed->state = MeshState::failed;
      failed->error = error;
      _store.put(*failed);
    } catch (const Error& disk) {
      failed.reset();
      error = disk;
    }
  }
  {
    const std::lock_guard lock(_mutex);
    LiveMesh& mesh = _index.known(id);
    mesh.meshing = false;
    mesh.ending = true;
    if (failed) {
      mesh.stage = Stage::failed;
      mesh.error = std::move(error);
    } else {
      ++mesh.setbacks;
      mesh.setback = std::move(error);
    }
    ++mesh.version;
    _changed.notify_all();
  }
  if (failed && _options.meshed) {
    _options.meshed(*failed);
  }
}

void Preparation::work() {
  const std::stop_token stop = _stopping.get_token();
  std::unique_lock lock(_mutex);
  while (_changed.wait(lock, stop, [&] { return _index.any_queued(); }) && !stop.stop_requested()) {
    const std::string id = _index.take();
    lock.unlock();
    try {
      prepare_in_background(id);
    } catch (const Error& error) {
      set_back(id, error);
    } catch (const std::bad_alloc&) {
      set_back(id,
               Error(Reason::limit_exceeded, "not enough memory for this mesh: make it coarser"));
    } catch (const std::exception& error) {
      set_back(id, Error(Reason::internal, std::string("meshing failed: ") + error.what()));
    }
    lock.lock();
    _index.release(id);
    _changed.notify_all();
  }
}

Preparation::Operator Preparation::prepare(const std::string& id, const PhaseListener& listener,
                                           const std::stop_token& stop) {
  const Visit visit(*this, id);
  LiveMesh& mesh = visit.mesh();
  std::unique_lock lock(_mutex);
  while (mesh.stage == Stage::pending) {
    if (!mesh.scheduled()) {
      _index.schedule(id);  // its preparation was cut short
      _changed.notify_all();
    }
    const bool meshing = mesh.meshing;
    const int setbacks = mesh.setbacks;
    lock.unlock();
    listener(meshing ? MeshState::meshing : MeshState::pending);
    lock.lock();
    const bool changed = _changed.wait(lock, stop, [&] {
      return mesh.stage != Stage::pending || mesh.meshing != meshing || mesh.setbacks != setbacks;
    });
    if (!changed) {
      throw Error(Reason::cancelled, "stopped while waiting for meshes/" + id);
    }
    if (mesh.stage == Stage::pending && mesh.setbacks != setbacks) {
      throw Error(*mesh.setback);
    }
  }
  if (mesh.stage == Stage::failed) {
    throw Error(*mesh.error);
  }
  if (mesh.operators.bytes > 0) {
    if (Operator ready = _cache.find(mesh.sha256)) {
      return ready;
    }
  }
  const std::uint64_t round = begin_factorizing(mesh);
  lock.unlock();
  try {
    listener(MeshState::factorizing);
  } catch (...) {
    end_factorizing(id, round, {}, false);
    throw;
  }
  return factorize(id, round, nullptr, true, stop);
}

}  // namespace anticrack::meshes
