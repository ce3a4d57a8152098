// SPDX-License-Identifier: GPL-3.0-or-later
//
// Store, cache and catalogue over the real mesher and the real operators.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

#include "digest/digest.hpp"
#include "errors/errors.hpp"
#include "mesher/helper.hpp"
#include "meshes/mesh_catalogue.hpp"
#include "operators/mesh_operator.hpp"
#include "operators/operator_cache.hpp"
#include "records/mesh_record.hpp"
#include "store/store.hpp"
#include "support/eventually.hpp"
#include "support/failing_store.hpp"
#include "support/paper_geometry.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::testing {

/// A door in front of something slow: whoever passes waits while it is shut, or until stopped.
class Door {
 public:
  void shut() {
    const std::lock_guard lock(_mutex);
    _open = false;
  }
  void open() {
    {
      const std::lock_guard lock(_mutex);
      _open = true;
    }
    _changed.notify_all();
  }
  void pass(const std::stop_token& stop) {
    std::unique_lock lock(_mutex);
    ++_waiting;
    _changed.wait(lock, stop, [&] { return _open; });
    --_waiting;
  }
  int waiting() const {
    const std::lock_guard lock(_mutex);
    return _waiting;
  }

 private:
  mutable std::mutex _mutex;
  std::condition_variable_any _changed;
  bool _open = true;
  int _waiting = 0;
};

struct BackendOptions {
  std::uint64_t memory_budget = std::uint64_t{1} << 30;
  std::size_t max_pending = 64;
  std::size_t max_meshes = 10'000;
  std::string data_folder = {};   ///< of the store; empty: below the backend's own folder
  std::uint64_t disk_budget = 0;  ///< as store::StoreOptions
  std::function<void(const records::MeshRecord&)> meshed = {};
  bool mesher_hangs = false;  ///< a program in its place that does nothing until it is killed
};

class Backend {
 public:
  explicit Backend(const BackendOptions& options = {})
      : store(std::make_unique<FailingStore>(store::StoreOptions{
            options.data_folder.empty() ? (folder / "data").string() : options.data_folder,
            options.disk_budget})),
        cache(options.memory_budget,
              [this](std::shared_ptr<const mesh::Mesh> mesh, std::stop_token stop) {
                if (mesh->triangle_count() >= kept_out) {
                  door.pass(deaf ? std::stop_token() : stop);
                }
                return operators::MeshOperator::factorise(std::move(mesh), 2, stop);
              }),
        catalogue(catalogue_options(options), *store, cache) {}

  /// The paper's membrane with elements of this size. Each size is another mesh.
  static records::MeshDefinition definition(double size = 0.1) {
    return records::GeometrySource{paper_geometry(), {mesh::Preset::uniform, size}};
  }
  std::string create(double size = 0.1) { return catalogue.create(definition(size), "", "").id; }

  records::MeshState state(const std::string& id) const { return catalogue.get(id).state; }
  /// Waits until the mesh has this state.
  bool reaches(const std::string& id, records::MeshState wanted) const {
    return eventually([&] { return state(id) == wanted; });
  }

  /// Sleeps until the operators are there, to be held by nobody else; `hear` gets all news. Throws
  /// the error of the wait, busy as soon as others hold the memory, cancelled on `stop`.
  std::shared_ptr<const operators::MeshOperator> prepare(
      const std::string& id, const std::stop_token& stop = {},
      const std::function<void(const meshes::MeshNews&)>& hear = {}) {
    std::mutex mutex;
    std::condition_variable_any changed;
    std::optional<meshes::MeshNews> last;
    meshes::MeshWaits waits(catalogue, [&](const meshes::MeshNews& news) {
      if (hear) hear(news);
      if (news.phase < meshes::MeshNews::Phase::waits_for_memory) return;
      const std::lock_guard lock(mutex);
      last = news;
      changed.notify_all();
    });
    waits.begin(id, records::Priority::normal, std::chrono::steady_clock::now());
    std::unique_lock lock(mutex);
    if (!changed.wait(lock, stop, [&] { return last.has_value(); }))
      throw errors::Error(errors::Reason::cancelled, "stopped");
    if (last->error) throw errors::Error(*last->error);
    if (!last->mesh_operator) throw errors::Error(errors::Reason::busy, "memory is held by others");
    return last->mesh_operator;
  }

  /// An upload with this content.
  records::UploadRef upload(const std::string& content, const std::string& owner = {}) {
    const std::string part = store->new_upload_path(content.size());
    std::ofstream(part, std::ios::binary) << content;
    records::UploadRef result{digest::Sha256().add(content).finish(), {}};
    store->keep_uploads({{part, result.sha256}}, owner);
    return result;
  }

  TemporaryFolder folder;
  Door door;                             ///< of the factorisation
  std::atomic<bool> deaf{false};         ///< a stop is noticed behind the door only
  std::atomic<std::size_t> kept_out{0};  ///< smaller meshes pass beside the door, triangles
  std::unique_ptr<FailingStore> store;
  operators::OperatorCache cache;
  meshes::MeshCatalogue catalogue;

 private:
  meshes::CatalogueOptions catalogue_options(const BackendOptions& options) const {
    meshes::CatalogueOptions result;
    result.helper.executable = ANTICRACK_MESHER;
    result.max_pending = options.max_pending;
    result.max_meshes = options.max_meshes;
    result.meshed = options.meshed;
    if (options.mesher_hangs) {
      result.helper.executable = (folder / "hanging-mesher").string();
      std::ofstream(result.helper.executable) << "#!/bin/sh\nexec sleep 3600\n";
      std::filesystem::permissions(result.helper.executable, std::filesystem::perms::owner_all);
    }
    return result;
  }
};

}  // namespace anticrack::testing
