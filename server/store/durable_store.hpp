// SPDX-License-Identifier: GPL-3.0-or-later
//
// The store. Three kinds of threads meet here:
//   - writers: files are written under temporary names by the thread that brings them; names are
//     given and taken, and records changed, by one thread at a time (GroupCommit);
//   - readers: one connection under a mutex; WAL lets them read while a writer waits for the disk;
//   - holders of what was read, who need no lock.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "store/common_store.hpp"
#include "store/group_commit.hpp"
#include "store/requests.hpp"
#include "store/sqlite.hpp"

namespace anticrack::store {

class DurableStore : public CommonStore {
 public:
  /// Makes or opens the folder, and removes the files in it that no record names. Throws
  /// errors::Error (storage, disk_full).
  explicit DurableStore(const StoreOptions& options);

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
  std::vector<EndedJob> ended() const override;
  std::shared_ptr<const records::BlockSource> result(const std::string& job) const override;
  void expire(const std::string& job, records::Clock::time_point now) override;
  void erase_job(const std::string& id) override;

  std::optional<std::string> upload_path(const std::string& sha256,
                                         const std::string& owner) const override;
  records::Clock::time_point keep_uploads(const std::vector<Upload>& uploads,
                                          const std::string& owner) override;
  void erase_upload(const std::string& sha256, const std::string& owner) override;
  std::size_t expire_uploads(records::Clock::time_point before) override;

  Usage usage() const override;
  std::vector<OwnerUsage> owners() const override;

 private:
  struct FileName {
    FileKind kind;
    std::string sha256;
  };

  Files& files(FileKind kind);
  std::uint64_t database_bytes() const;
  DiskUsage::Reservation reserve(std::uint64_t bytes) override;
  void remove_unreferenced(Connection& connection);
  void save(Connection& connection, const records::MeshRecord& record, const std::string& bytes);

  template <class Read>
  auto reading(Read&& read) const {
    const std::lock_guard lock(_reader_mutex);
    return read(_reader);
  }
  std::optional<Row> row(FileKind kind, const std::string& id) const override;
  std::vector<Row> page(FileKind kind, const Page& page) const override;
  std::optional<Row> row_of_request(const std::string& owner, const std::string& request_id,
                                    const std::string& fingerprint) const override;
  std::vector<Row> unfinished_rows() const override;
  std::optional<mesh::Bytes> encoded_mesh(const std::string& sha256) const override;
  std::vector<UploadRecord> uploads_where(const char* comparison, const std::string& owner,
                                          const std::string& sha256,
                                          std::size_t count) const override;

  const std::string _folder;
  Files _meshes;
  /// Files to which no record refers any more, or never did. Used by the thread that commits.
  std::vector<FileName> _unreferenced;
  GroupCommit _writer;
  mutable std::mutex _reader_mutex;
  mutable Connection _reader;
};

}  // namespace anticrack::store
