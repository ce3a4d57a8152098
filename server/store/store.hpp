// SPDX-License-Identifier: GPL-3.0-or-later
//
// What outlives a request. One interface; the implementation of this version keeps records and
// blocks in memory and uploads as files.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "store/block.hpp"
#include "store/records.hpp"

namespace anticrack::store {

/// Contract:
/// 1. Every method may be called from any thread and is atomic.
/// 2. A method that writes has either written all or, when it throws errors::Error (storage),
///    nothing.
/// 3. Lists are newest first and stable under insertion: `after` is the id of the last record of
///    the previous page (empty: from the start); an unknown one throws not_found.
/// 4. Ids are unique for ever; an erased id does not come back by itself.
class Store {
 public:
  virtual ~Store() = default;

  virtual void put(const MeshRecord& record) = 0;  ///< inserts or replaces
  virtual std::optional<MeshRecord> mesh(const std::string& id) const = 0;
  virtual std::vector<MeshRecord> meshes(const std::string& after, std::size_t count) const = 0;
  virtual void erase_mesh(const std::string& id) = 0;

  /// The triangulation of a mesh record that has one, and its block for ReadMesh.
  virtual void put_triangulation(const std::string& id, std::shared_ptr<const mesh::Mesh> mesh,
                                 std::shared_ptr<const Block> block) = 0;
  virtual std::shared_ptr<const mesh::Mesh> triangulation(const std::string& id) const = 0;
  virtual std::shared_ptr<const Block> mesh_block(const std::string& id) const = 0;

  /// Inserts the job, or returns the one that was made with this (non-empty) request id before;
  /// throws request_id_reused when that one had another fingerprint.
  virtual JobRecord create(const JobRecord& record, const std::string& request_id,
                           const std::string& fingerprint) = 0;
  virtual void put(const JobRecord& record) = 0;  ///< replaces
  virtual std::optional<JobRecord> job(const std::string& id) const = 0;
  virtual std::vector<JobRecord> jobs(const std::string& after, std::size_t count) const = 0;
  virtual void erase_job(const std::string& id) = 0;  ///< and its result

  virtual void put_result(const std::string& job, std::shared_ptr<const Block> block) = 0;
  virtual std::shared_ptr<const Block> result(const std::string& job) const = 0;

  /// Where the upload with this hash lies; empty where there is none.
  virtual std::optional<std::string> upload_path(const std::string& sha256) const = 0;
  /// A fresh file to receive an upload; `keep_upload` moves it to its place, atomically.
  virtual std::string new_upload_path() = 0;
  virtual void keep_upload(const std::string& path, const std::string& sha256) = 0;
};

/// Records in memory, uploads below `folder` (made if missing, left-over parts removed).
/// Throws errors::Error (storage) when the folder cannot be written.
std::unique_ptr<Store> make_memory_store(const std::string& folder);

}  // namespace anticrack::store
