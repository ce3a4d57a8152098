// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/mesh_catalogue.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

#include "digest/digest.hpp"
#include "errors/errors.hpp"
#include "mesh/refine.hpp"
#include "meshes/identity.hpp"
#include "meshes/preparation.hpp"
#include "meshes/size_class.hpp"
#include "meshes/summary.hpp"
#include "meshes/triangulation.hpp"
#include "store/queue.hpp"

namespace anticrack::meshes {

namespace {

using errors::Error;
using errors::Reason;
using records::MeshRecord;
using records::MeshState;

constexpr std::size_t id_digits = 16;

Error in_use(const std::string& id, const char* why) {
  return {Reason::in_use, fmt::format("meshes/{} is in use: {}", id, why)};
}

/// Is told when the last job on a mesh has ended, which may be after the catalogue was destroyed.
class Ends {
 public:
  explicit Ends(Preparation& preparation) : _preparation(&preparation) {}
  void of(const std::string& mesh) {
    const std::lock_guard lock(_mutex);
    if (_preparation != nullptr) _preparation->let_go(mesh);
  }
  void forget() {
    const std::lock_guard lock(_mutex);
    _preparation = nullptr;
  }

 private:
  std::mutex _mutex;
  Preparation* _preparation;
};

void require_memory(const mesh::Mesh& mesh, std::uint64_t budget) {
  const std::uint64_t wanted = operators::estimate_bytes(mesh);
  if (wanted <= budget) return;
  constexpr std::uint64_t mebibyte = 1 << 20;
  throw Error(Reason::limit_exceeded,
              "the operators of a finer mesh ({} triangles) need about {} MiB, more "
              "than the memory-budget of {} MiB of the server; ask for a larger error, "
              "or start the server with more",
              mesh.triangle_count(), (wanted + mebibyte - 1) / mebibyte, budget / mebibyte)
      .at("memory_budget");
}

}  // namespace

struct MeshCatalogue::State {
  State(CatalogueOptions catalogue_options, store::Store& records,
        operators::OperatorCache& operator_cache)
      : options(std::move(catalogue_options)),
        store(records),
        cache(operator_cache),
        preparation(options, store, cache) {}

  const CatalogueOptions options;
  store::Store& store;
  operators::OperatorCache& cache;
  Preparation preparation;
  const std::shared_ptr<Ends> ends = std::make_shared<Ends>(preparation);
  std::size_t claims = 0;  ///< meshes being claimed for the queue; guarded by the lock

  MeshIndex& index() { return preparation.index(); }

  /// The cache's key for the operators of a mesh, empty if it is not meshed.
  std::string key(const std::string& id) {
    const auto lock = preparation.lock();
    const LiveMesh* mesh = index().find(id);
    return mesh == nullptr || mesh->stage != Stage::meshed ? std::string() : mesh->sha256;
  }

  // Throws if there is no room for another mesh. With the lock held, as all below:
  void require_room() const {
    if (preparation.queued() + claims < options.max_pending) return;
    throw Error(Reason::busy, "{} meshes are waiting for the mesher: try again later",
                options.max_pending)
        .retry_after(operators::retry_delay);
  }

  /// For a mesh that is created again: resumes its preparation if that was interrupted. Returns
  /// false if the mesh must be made.
  bool resume(const LiveMesh* mesh, const std::string& id, bool for_job) {
    if (mesh == nullptr || mesh->stage == Stage::failed) return false;
    if (mesh->stage != Stage::pending) return true;
    if (mesh->for_job && !for_job) return false;  // the record must change
    if (!mesh->run) {
      require_room();
      preparation.begin(id, !mesh->for_job);
    }
    return true;
  }

  /// Reserves a place in the index for a new mesh, so that no other call makes it meanwhile.
  LiveMesh& claim(const std::string& id) {
    if (index().find(id) == nullptr && index().size() >= options.max_meshes) {
      throw Error(Reason::quota_exceeded,
                  "the server keeps {} meshes and may keep no more: delete some",
                  options.max_meshes);
    }
    LiveMesh& mesh = index().add(id);
    mesh.claimed = true;
    ++claims;
    return mesh;
  }

  /// Ends a claim. `record`: as it was written, null if it could not be; `begin`: prepare the mesh.
  void end_claim(const std::string& id, const MeshRecord* record, bool begin = true) {
    LiveMesh& mesh = index().add(id);
    mesh.claimed = false;
    --claims;
    if (record != nullptr) {
      mesh.stage = record->sha256.empty() ? Stage::pending : Stage::meshed;
      mesh.sha256 = record->sha256;
      if (record->triangle_count > 0) mesh.size_class = size_class(record->triangle_count);
      mesh.error.reset();
      mesh.for_job = record->for_job;
      ++mesh.version;
      if (begin) preparation.begin(id, !mesh.for_job);
    } else if (mesh.stage == Stage::absent) {
      index().remove(id);
    }
    preparation.serve(id);
    preparation.notify();
  }
};

MeshCatalogue::MeshCatalogue(CatalogueOptions options, store::Store& store,
                             operators::OperatorCache& cache)
    : _state(std::make_unique<State>(std::move(options), store, cache)) {}

MeshWaits::MeshWaits(MeshCatalogue& catalogue, Tell tell)
    : _preparation(catalogue._state->preparation), _tell(std::move(tell)) {}

MeshCatalogue::~MeshCatalogue() { _state->ends->forget(); }

MeshRecord MeshCatalogue::create(const records::MeshDefinition& definition,
                                 const std::string& title, const std::string& owner, bool for_job) {
  const std::size_t triangles = check_definition(definition, owner, _state->options, _state->store);
  const std::string id = identity(definition, owner).substr(0, id_digits);
  Preparation& preparation = _state->preparation;
  preparation.look_again(id);
  {
    auto lock = preparation.lock_settled(id);
    if (_state->resume(_state->index().find(id), id, for_job)) {
      lock.unlock();
      return get(id);
    }
    _state->require_room();
    LiveMesh& mesh = _state->claim(id);
    mesh.definition = identity(definition);
    mesh.owner = owner;
    mesh.size_class = meshes::size_class(triangles);
  }
  MeshRecord record;
  try {
    std::optional<MeshRecord> failed = _state->store.mesh(id);
    // No mesh fails for the disk: a mesh with this error has a damaged record, and nothing to keep.
    if (failed && !(failed->error && failed->error->reason() == Reason::storage)) {
      record = std::move(*failed);
      record.error.reset();
    } else {
      record.id = id;
      record.owner = owner;
      record.title = title;
      record.definition = definition;
      record.created = records::Clock::now();
    }
    // A failed mesh with a triangulation needs only its operators again.
    record.state = record.sha256.empty() ? MeshState::pending : MeshState::evicted;
    record.for_job = for_job;
    _state->store.put(record);
  } catch (...) {
    const auto lock = preparation.lock();
    _state->end_claim(id, nullptr);
    throw;
  }
  const auto lock = preparation.lock();
  _state->end_claim(id, &record);
  return seen(_state->index().known(id), std::move(record), false);
}

MeshRecord MeshCatalogue::refine(const Parent& parent, std::span<const std::uint8_t> levels,
                                 std::size_t max_triangles) {
  const records::MeshDefinition definition = records::Refinement{
      parent.mesh, parent.job, digest::Sha256().add(std::as_bytes(levels)).finish()};
  MeshRecord record;
  record.id = identity(definition, parent.owner).substr(0, id_digits);
  Preparation& preparation = _state->preparation;
  {
    auto lock = preparation.lock_settled(record.id);
    const LiveMesh* mesh = _state->index().find(record.id);
    if (mesh != nullptr && mesh->stage == Stage::meshed) {
      lock.unlock();
      return get(record.id);
    }
    LiveMesh& claimed = _state->claim(record.id);
    claimed.definition = identity(definition);
    claimed.owner = parent.owner;
  }
  try {
    const auto start = std::chrono::steady_clock::now();
    mesh::Mesh coarse = *triangulation(parent.mesh);
    // The encoding of a mesh does not have the bound, without which bisection would begin at the
    // longest edges again.
    coarse.bisection_bound = get(parent.mesh).bisection_bound;
    const mesh::Mesh fine =
        mesh::refine(coarse, levels, std::min(max_triangles, _state->options.max_triangles));
    if (fine.triangle_count() == coarse.triangle_count()) {
      throw Error(Reason::numerical,
                  "the triangles that the error comes from are as small as rounding lets them be; "
                  "ask for a larger error, or put the origin near them");
    }
    require_memory(fine, _state->cache.budget());
    record.owner = parent.owner;
    record.title = "a stage of jobs/" + parent.job;
    record.definition = definition;
    record.created = records::Clock::now();
    meshed(fine, start, record);
    summarize(fine, record);
    _state->store.put(record, fine);
  } catch (...) {
    const auto lock = preparation.lock();
    _state->end_claim(record.id, nullptr);
    throw;
  }
  const auto lock = preparation.lock();
  _state->end_claim(record.id, &record, false);
  const LiveMesh& mesh = _state->index().known(record.id);
  return seen(mesh, std::move(record), false);
}

std::shared_ptr<const operators::MeshOperator> MeshCatalogue::operators_of(
    const Passing& passing, std::shared_ptr<const mesh::Mesh> mesh, const std::stop_token& stop) {
  operators::OperatorCache& cache = _state->cache;
  require_memory(*mesh, cache.budget() - std::min(cache.budget(), passing.held));
  constexpr int most_waits = 30;
  for (int k = 0;; ++k) {
    try {
      auto found = cache.acquire(passing.name, mesh, stop, passing.owner);
      const auto* const here = found.get();
      return {here, [found = std::move(found), &cache, name = passing.name](const auto*) mutable {
                found.reset();
                cache.evict(name);
              }};
    } catch (const Error& error) {
      if (error.reason() != Reason::busy || k == most_waits) throw;
    }
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any().wait_for(lock, stop, operators::retry_delay,
                                           [] { return false; });
    if (stop.stop_requested()) throw Error(Reason::cancelled, "stopped while waiting for memory");
  }
}

std::size_t MeshCatalogue::max_triangles() const noexcept { return _state->options.max_triangles; }

MeshRecord MeshCatalogue::get(const std::string& id) const {
  return _state->preparation.record(id);
}

std::vector<MeshRecord> MeshCatalogue::list(const store::Page& page) const {
  std::vector<MeshRecord> records = _state->store.meshes(page);
  const auto lock = _state->preparation.lock();
  for (MeshRecord& record : records)
    if (const LiveMesh* mesh = _state->index().find(record.id))
      record = seen(*mesh, std::move(record), _state->cache.contains(mesh->sha256));
  return records;
}

std::shared_ptr<const mesh::Mesh> MeshCatalogue::triangulation(const std::string& id) const {
  const MeshRecord record = get(id);
  if (record.sha256.empty()) {
    throw Error(Reason::not_ready,
                record.error
                    ? fmt::format("meshes/{} failed: {}", id, record.error->what())
                    : fmt::format("meshes/{} is not meshed yet: wait until it is READY", id));
  }
  const std::shared_ptr<const mesh::Mesh> mesh = _state->store.triangulation(record.sha256);
  if (!mesh) {
    get(id);  // throws if it was erased meanwhile
    throw Error(Reason::storage, "the triangulation of meshes/{} is missing", id);
  }
  return mesh;
}

std::shared_ptr<const records::BlockSource> MeshCatalogue::read(const std::string& id) const {
  return records::in_memory(std::make_shared<const records::Block>(mesh_block(*triangulation(id))));
}

MeshRecord MeshCatalogue::warm(const std::string& id, bool pin) {
  _state->preparation.look_again(id);
  {
    const auto lock = _state->preparation.lock_settled(id);
    LiveMesh& mesh = _state->index().known(id);
    if (mesh.stage == Stage::failed) throw Error(*mesh.error);
    const bool there = mesh.stage == Stage::meshed &&
                       (pin ? _state->cache.pin(mesh.sha256) : _state->cache.contains(mesh.sha256));
    // Operators in memory through an equal mesh have not been measured for this one.
    if (!there || mesh.operators.bytes == 0) {
      if (!mesh.run) _state->require_room();
      _state->preparation.begin(id, true);
    }
    mesh.pin = mesh.pin || (pin && !there);
  }
  return get(id);
}

MeshRecord MeshCatalogue::evict(const std::string& id) {
  std::string sha256;
  bool held = false;
  {
    const auto lock = _state->preparation.lock();
    LiveMesh& mesh = _state->index().known(id);
    mesh.pin = false;
    held = mesh.stage == Stage::meshed && mesh.run && !mesh.run->visible;
    sha256 = mesh.sha256;
  }
  using Eviction = operators::OperatorCache::Eviction;
  held = held || (!sha256.empty() && _state->cache.evict(sha256) == Eviction::in_use);
  if (held)
    throw in_use(id, "a job or a factorisation holds its operators; wait for it or cancel it");
  return get(id);
}

void MeshCatalogue::erase(const std::string& id) {
  Preparation& preparation = _state->preparation;
  MeshIndex& index = preparation.index();
  preparation.look_again(id);
  const store::Queue* const queue = _state->store.queue();
  const bool needed = queue != nullptr && queue->needs(id);
  auto lock = preparation.lock_settled(id);
  LiveMesh& mesh = index.known(id);
  if (needed || !mesh.users.expired())
    throw in_use(id, "a job that has not ended needs it; wait for it or cancel it");
  preparation.fail_waits(mesh, Error(Reason::not_found, "meshes/{} was deleted", id));
  const std::shared_ptr<Run> run = preparation.give_up(mesh);
  const Stage stage = std::exchange(mesh.stage, Stage::absent);
  mesh.claimed = true;
  lock.unlock();
  if (run) run->stop.request_stop();
  try {
    _state->store.erase_mesh(id);
  } catch (...) {
    lock.lock();
    mesh.stage = stage;
    mesh.claimed = false;
    preparation.notify();
    throw;
  }
  lock.lock();
  const std::string orphan = index.shared(id) ? std::string() : mesh.sha256;
  index.remove(id);
  preparation.notify();
  lock.unlock();
  if (!orphan.empty()) _state->cache.evict(orphan);
}

std::shared_ptr<void> MeshCatalogue::use(const std::string& id) {
  _state->preparation.look_again(id);
  const auto lock = _state->preparation.lock();
  LiveMesh& mesh = _state->index().known(id);
  std::shared_ptr<void> user = mesh.users.lock();
  if (!user) {
    user = std::shared_ptr<void>(new char, [ends = _state->ends, id](void* one) {
      delete static_cast<char*>(one);
      ends->of(id);
    });
    mesh.users = user;
    mesh.used = true;
  }
  return user;
}

bool MeshCatalogue::ready(const std::string& id) const {
  const std::string key = _state->key(id);
  return !key.empty() && _state->cache.contains(key);
}

bool MeshCatalogue::pinned(const std::string& id) const {
  const std::string key = _state->key(id);
  return !key.empty() && _state->cache.pinned(key);
}

std::vector<std::string> MeshCatalogue::in_memory() const {
  auto lock = _state->preparation.lock();
  auto meshes = _state->index().measured();
  lock.unlock();
  std::vector<std::string> ids;
  for (auto& [id, sha256] : meshes)
    if (_state->cache.contains(sha256)) ids.push_back(std::move(id));
  return ids;
}

std::uint64_t MeshCatalogue::meshings() const noexcept { return _state->preparation.meshings(); }

int MeshCatalogue::pending() const {
  const auto lock = _state->preparation.lock();
  return _state->index().pending();
}

}  // namespace anticrack::meshes
