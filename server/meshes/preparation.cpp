// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/preparation.hpp"

#include <new>
#include <utility>
#include <variant>

#include "meshes/summary.hpp"
#include "store/digest.hpp"

namespace anticrack::meshes {

namespace {

using errors::Error;
using errors::Reason;
using store::MeshRecord;
using store::MeshState;
using Steady = std::chrono::steady_clock;

constexpr int thread_count = 2;  // so that one large mesh does not hold up the small ones

double seconds_since(Steady::time_point start) {
  return std::chrono::duration<double>(Steady::now() - start).count();
}

bool waits_for_mesher(MeshState state) {
  return state == MeshState::pending || state == MeshState::meshing;
}

/// An error that the same mesh would meet again, however long one waits.
bool lasting(const Error& error) {
  return error.reason() != Reason::busy && error.reason() != Reason::cancelled;
}

}  // namespace

Preparation::Preparation(CatalogueOptions options, store::Store& store,
                         operators::OperatorCache& cache)
    : _options(std::move(options)), _store(store), _cache(cache) {
  for (int i = 0; i < thread_count; ++i) {
    _threads.emplace_back([this] { work(); });
  }
}

Preparation::~Preparation() {
  _stopping.request_stop();
  _threads.clear();  // joins
}

MeshRecord Preparation::stored(const std::string& id) const {
  std::optional<MeshRecord> record = _store.mesh(id);
  if (!record) {
    throw Error(Reason::not_found, "there is no meshes/" + id + ": create it first");
  }
  return std::move(*record);
}

MeshRecord Preparation::seen_now(MeshRecord record) const {
  if (!waits_for_mesher(record.state) && record.state != MeshState::failed) {
    const auto live = _live.find(record.id);
    const bool factorizing =
        live != _live.end() && (live->second.scheduled || live->second.factorizing > 0);
    // The cache has an operator a moment before the record has what is known of it.
    const bool ready = record.operator_bytes > 0 && _cache.contains(record.sha256);
    record.state = ready         ? MeshState::ready
                   : factorizing ? MeshState::factorizing
                                 : MeshState::evicted;
  }
  return record;
}

void Preparation::schedule(const std::string& id) {
  if (Live& live = _live[id]; live.scheduled) {
    live.again = true;  // its failure can be seen before its thread is done with it
  } else {
    enqueue(id);
  }
}

void Preparation::enqueue(const std::string& id) {
  _live[id].scheduled = true;
  _queue.push_back(id);
  _changed.notify_all();
}

void Preparation::release(const std::string& id) {
  Live& live = _live[id];
  live.scheduled = false;
  if (std::exchange(live.again, false)) {
    enqueue(id);
  }
  forget_if_idle(id);
  _changed.notify_all();
}

void Preparation::put(const MeshRecord& record) {
  _store.put(record);
  _changed.notify_all();
}

void Preparation::forget_if_idle(const std::string& id) {
  const auto live = _live.find(id);
  if (live != _live.end() && !live->second.scheduled && live->second.factorizing == 0) {
    _live.erase(live);
  }
}

void Preparation::begin_factorizing(MeshRecord record) {
  Live& live = _live[record.id];
  if (live.factorizing == 0) {
    record.state = MeshState::factorizing;
    put(record);
    live.since = Steady::now();
  }
  ++live.factorizing;
}

/// The first of those who wait together records the outcome and how long it took.
void Preparation::end_factorizing(const std::string& id, const Operator& result,
                                  const std::optional<Error>& error) {
  const std::lock_guard lock(_mutex);
  Live& live = _live[id];
  --live.factorizing;
  if (MeshRecord record = stored(id); record.state == MeshState::factorizing) {
    if (result) {
      record.state = MeshState::ready;
      record.operator_bytes = result->bytes();
      record.theta_star = result->theta_star();
      record.factorize_seconds = seconds_since(live.since);
      put(record);
    } else if (error && lasting(*error)) {
      record.state = MeshState::failed;
      record.error = error;
      put(record);
    } else if (live.factorizing == 0) {
      record.state = MeshState::evicted;
      put(record);
    }
  }
  forget_if_idle(id);
}

Preparation::Operator Preparation::factorize(const std::string& id, const std::string& sha256,
                                             const std::stop_token& stop) {
  try {
    Operator result = _cache.acquire(sha256, _store.triangulation(id), stop);
    end_factorizing(id, result, std::nullopt);
    return result;
  } catch (const Error& error) {
    end_factorizing(id, nullptr, error);
    throw;
  } catch (const std::exception& thrown) {
    const Error error(Reason::internal, std::string("factorising failed: ") + thrown.what());
    end_factorizing(id, nullptr, error);
    throw Error(error);
  }
}

std::string Preparation::require_upload(const store::UploadRef& upload) const {
  const std::optional<std::string> path = _store.upload_path(upload.sha256);
  if (!path) {
    throw Error(Reason::not_found,
                "there is no uploads/" + upload.sha256 + ": upload the file first")
        .at("upload");
  }
  return *path;
}

void Preparation::triangulate(const std::string& id) {
  MeshRecord record;
  {
    const std::lock_guard lock(_mutex);
    record = stored(id);
    record.state = MeshState::meshing;
    put(record);
  }
  const auto start = Steady::now();
  mesh::MesherRequest request;
  if (const auto* source = std::get_if<store::GeometrySource>(&record.definition)) {
    request =
        mesh::GenerateRequest{mesh::plan(source->geometry, source->options, _options.max_triangles),
                              _options.max_triangles};
  } else {
    const auto& upload = std::get<store::UploadRef>(record.definition);
    request = mesh::ImportRequest{require_upload(upload), upload.options, _options.max_triangles};
  }
  ++_meshings;
  auto mesh = std::make_shared<const mesh::Mesh>(
      mesher::run(_options.helper, request, _stopping.get_token()));
  record.mesh_seconds = seconds_since(start);
  record.sha256 = store::Sha256().add(mesh::encode(*mesh)).finish();
  summarize(*mesh, record);
  auto block = std::make_shared<const store::Block>(mesh_block(*mesh));
  _store.put_triangulation(id, std::move(mesh), std::move(block));
  const std::lock_guard lock(_mutex);
  begin_factorizing(std::move(record));
}

void Preparation::prepare_in_background(const std::string& id) {
  if (!_store.triangulation(id)) {
    triangulate(id);
  } else {
    const std::lock_guard lock(_mutex);
    begin_factorizing(stored(id));
  }
  factorize(id, stored(id).sha256, _stopping.get_token());
}

void Preparation::fail(const std::string& id, const Error& error) {
  const std::lock_guard lock(_mutex);
  MeshRecord record = stored(id);
  if (waits_for_mesher(record.state)) {  // else end_factorizing has recorded it
    const bool failed = lasting(error);
    record.state = failed ? MeshState::failed : MeshState::pending;
    record.error = failed ? std::optional<Error>(error) : std::nullopt;
    put(record);
  }
}

void Preparation::work() {
  const std::stop_token stop = _stopping.get_token();
  std::unique_lock lock(_mutex);
  while (_changed.wait(lock, stop, [&] { return !_queue.empty(); }) && !stop.stop_requested()) {
    const std::string id = std::move(_queue.front());
    _queue.pop_front();
    lock.unlock();
    try {
      prepare_in_background(id);
    } catch (const Error& error) {
      fail(id, error);
    } catch (const std::bad_alloc&) {
      fail(id, Error(Reason::limit_exceeded, "not enough memory for this mesh: make it coarser"));
    } catch (const std::exception& error) {
      fail(id, Error(Reason::internal, std::string("meshing failed: ") + error.what()));
    }
    lock.lock();
    release(id);
  }
}

Preparation::Operator Preparation::prepare(const std::string& id, const PhaseListener& listener,
                                           const std::stop_token& stop) {
  std::unique_lock lock(_mutex);
  MeshRecord record = stored(id);
  while (waits_for_mesher(record.state)) {
    if (!_live[id].scheduled) {
      enqueue(id);  // its preparation was cut short
    }
    const MeshState state = record.state;
    lock.unlock();
    listener(state);
    lock.lock();
    const bool changed = _changed.wait(lock, stop, [&] {
      record = stored(id);
      return record.state != state;
    });
    if (!changed) {
      throw Error(Reason::cancelled, "stopped while waiting for meshes/" + id);
    }
  }
  if (record.state == MeshState::failed) {
    throw Error(*record.error);
  }
  if (record.operator_bytes > 0) {
    if (Operator ready = _cache.find(record.sha256)) {
      return ready;
    }
  }
  const std::string sha256 = record.sha256;
  begin_factorizing(std::move(record));
  lock.unlock();
  try {
    listener(MeshState::factorizing);
  } catch (...) {
    end_factorizing(id, nullptr, std::nullopt);
    throw;
  }
  return factorize(id, sha256, stop);
}

}  // namespace anticrack::meshes
