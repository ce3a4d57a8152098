// SPDX-License-Identifier: GPL-3.0-or-later
//
// The store in PostgreSQL, for any number of servers. The data folder of each has what it can do
// without: uploads on their way and copies of those that were read, and results of jobs that run.
#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "group/queue.hpp"
#include "postgres/pool.hpp"
#include "store/common_store.hpp"

namespace anticrack::group {

/// How to reach the database at this address. Throws errors::Error (invalid_argument), also where
/// the address has a password, which the command line shows to others.
postgres::Settings settings_of(const std::string& url);

class Store final : public store::CommonStore {
 public:
  /// Makes the tables where there are none. Throws errors::Error (storage): the database cannot be
  /// reached, lets nobody in or is of another version, or the folder is a store of its own.
  explicit Store(const store::StoreOptions& options);

  void put(const records::MeshRecord& record) override;
  void put(const records::MeshRecord& record, const mesh::Mesh& triangulation) override;
  std::size_t mesh_count() const override;
  void erase_mesh(const std::string& id) override;

  records::JobRecord create(const records::JobRecord& record,
                            const std::string& fingerprint) override;
  void put(const records::JobRecord& record) override;
  void finish(const records::JobRecord& record,
              std::shared_ptr<const records::BlockSource> result) override;
  bool set_running(bool running) override;
  std::vector<store::EndedJob> ended() const override;
  std::shared_ptr<const records::BlockSource> result(const std::string& job) const override;
  void expire(const std::string& job, records::Clock::time_point now) override;
  void erase_job(const std::string& id) override;

  std::optional<std::string> upload_path(const std::string& sha256,
                                         const std::string& owner) const override;
  records::Clock::time_point keep_uploads(const std::vector<store::Upload>& uploads,
                                          const std::string& owner) override;
  void erase_upload(const std::string& sha256, const std::string& owner) override;
  std::size_t expire_uploads(records::Clock::time_point before) override;

  store::Queue* queue() override { return &_queue; }
  store::Usage usage() const override;
  std::vector<store::OwnerUsage> owners() const override;
  std::optional<store::GroupState> group() const override;
  std::chrono::milliseconds unreachable() const override { return _pool.unreachable(); }

 private:
  void save(const records::MeshRecord& record, const std::vector<std::byte>* triangulation);
  std::optional<store::Row> row(store::FileKind kind, const std::string& id) const override;
  std::vector<store::Row> page(store::FileKind kind, const store::Page& page) const override;
  std::optional<store::Row> row_of_request(const std::string& owner, const std::string& request_id,
                                           const std::string& fingerprint) const override;
  std::vector<store::Row> unfinished_rows() const override;
  std::optional<mesh::Bytes> encoded_mesh(const std::string& sha256) const override;
  std::vector<store::UploadRecord> uploads_where(const char* comparison, const std::string& owner,
                                                 const std::string& sha256,
                                                 std::size_t count) const override;
  /// Deletes a row and the blob in that column, if no other row has it; returns the blob's name
  /// then. Throws not_found.
  std::vector<std::string> erase(const char* table, const char* blob, const std::string& id);
  /// Removes copies of uploads that nobody has any more.
  void remove_copies();

  mutable postgres::Pool _pool;
  std::mutex _removing;  ///< of copies in _uploads: one thread at a time
  Queue _queue;
};

}  // namespace anticrack::group
