// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/mesh_catalogue.hpp"

#include <optional>
#include <utility>
#include <variant>

#include "errors/errors.hpp"
#include "meshes/identity.hpp"
#include "meshes/preparation.hpp"

namespace anticrack::meshes {

namespace {

using errors::Error;
using errors::Reason;
using store::MeshRecord;
using store::MeshState;

constexpr std::size_t id_digits = 16;
constexpr std::size_t max_title_bytes = 200;
constexpr std::chrono::milliseconds retry_delay{1000};

Error queue_full(std::size_t pending) {
  Error error(Reason::busy, std::to_string(pending) +
                                " meshes wait for the mesher already: try again in a while");
  return error.retry_after(retry_delay);
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

  /// Of a mesh's operators in the cache; empty when it cannot have any.
  std::string key(const std::string& id) const {
    const std::optional<MeshRecord> record = store.mesh(id);
    return record && record->state != MeshState::failed ? record->sha256 : std::string();
  }

  /// Refuses what no run of the mesher could make a mesh of.
  void check(const store::MeshDefinition& definition) const {
    if (const auto* source = std::get_if<store::GeometrySource>(&definition)) {
      mesh::plan(source->geometry, source->options, options.max_triangles);
    } else {
      const auto& upload = std::get<store::UploadRef>(definition);
      mesh::check_for_upload(upload.options);
      mesher::require_msh(preparation.require_upload(upload));
    }
  }
};

MeshCatalogue::MeshCatalogue(CatalogueOptions options, store::Store& store,
                             operators::OperatorCache& cache)
    : _state(std::make_unique<State>(std::move(options), store, cache)) {}

MeshCatalogue::~MeshCatalogue() = default;

MeshRecord MeshCatalogue::create(const store::MeshDefinition& definition,
                                 const std::string& title) {
  if (title.size() > max_title_bytes) {
    throw Error(Reason::invalid_argument, "a title of " + std::to_string(title.size()) +
                                              " bytes: use at most " +
                                              std::to_string(max_title_bytes))
        .at("title");
  }
  _state->check(definition);
  const std::string id = identity(definition).substr(0, id_digits);

  Preparation& preparation = _state->preparation;
  const auto lock = preparation.lock();
  std::optional<MeshRecord> record = _state->store.mesh(id);
  if (record && record->state != MeshState::failed) {
    return preparation.seen_now(std::move(*record));
  }
  if (preparation.full()) {
    throw queue_full(_state->options.max_pending);
  }
  if (!record) {
    record.emplace();
    record->id = id;
    record->title = title;
    record->definition = definition;
    record->created = store::Clock::now();
  }
  record->error.reset();
  // A failed one that was meshed has only its operators to be made again.
  record->state = _state->store.triangulation(id) ? MeshState::evicted : MeshState::pending;
  _state->store.put(*record);
  preparation.schedule(id);
  return preparation.seen_now(std::move(*record));
}

MeshRecord MeshCatalogue::get(const std::string& id) const {
  const auto lock = _state->preparation.lock();
  return _state->preparation.seen_now(_state->preparation.stored(id));
}

std::vector<MeshRecord> MeshCatalogue::list(const std::string& after, std::size_t count) const {
  const auto lock = _state->preparation.lock();
  std::vector<MeshRecord> records = _state->store.meshes(after, count);
  for (MeshRecord& record : records) {
    record = _state->preparation.seen_now(std::move(record));
  }
  return records;
}

std::shared_ptr<const store::Block> MeshCatalogue::read(const std::string& id) const {
  const MeshRecord record = get(id);
  std::shared_ptr<const store::Block> block = _state->store.mesh_block(id);
  if (!block) {
    throw Error(Reason::not_ready,
                record.error
                    ? "meshes/" + id + " failed: " + record.error->what()
                    : "meshes/" + id + " is not meshed yet: wait until its state is READY");
  }
  return block;
}

std::shared_ptr<const operators::MeshOperator> MeshCatalogue::prepare(const std::string& id,
                                                                      const PhaseListener& listener,
                                                                      std::stop_token stop) {
  return _state->preparation.prepare(id, listener, stop);
}

std::shared_ptr<const operators::MeshOperator> MeshCatalogue::find(const std::string& id) const {
  const std::string key = _state->key(id);
  return key.empty() ? nullptr : _state->cache.find(key);
}

bool MeshCatalogue::ready(const std::string& id) const {
  const std::string key = _state->key(id);
  return !key.empty() && _state->cache.contains(key);
}

std::uint64_t MeshCatalogue::meshings() const noexcept {
  return _state->preparation.meshings();
}

}  // namespace anticrack::meshes
