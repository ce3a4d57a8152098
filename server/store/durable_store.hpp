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

#include "store/disk_usage.hpp"
#include "store/files.hpp"
#include "store/group_commit.hpp"
#include "store/requests.hpp"
#include "store/rows.hpp"
#include "store/sqlite.hpp"
#include "store/store.hpp"
#include "store/triangulations.hpp"
#include "store/upload_parts.hpp"

namespace anticrack::store {

class DurableStore final : public Store {
 public:
  /// Makes or opens the folder, and removes the files in it that no record names. Throws
  /// errors::Error (storage, disk_full).
  explicit DurableStore(const StoreOptions& options);

  void put(const records::MeshRecord& record) override;
  void put(const records::MeshRecord& record, const mesh::Mesh& triangulation) override;
  std::optional<records::MeshRecord> mesh(const std::string& id) const override;
  std::vector<records::MeshRecord> meshes(const Page& page) const override;
  std::size_t mesh_count() const override;
  void erase_mesh(const std::string& id) override;
  std::shared_ptr<const mesh::Mesh> triangulation(const std::string& sha256) const override;

  records::JobRecord create(const records::JobRecord& record,
                            const std::string& fingerprint) override;
  std::optional<records::JobRecord> created_before(const std::string& owner,
                                                   const std::string& request_id,
                                                   const std::string& fingerprint) const override;
  void put(const records::JobRecord& record) override;
  std::shared_ptr<Spool> new_spool() override;
  void finish(const records::JobRecord& record,
              std::shared_ptr<const records::BlockSource> result) override;
  std::optional<records::JobRecord> job(const std::string& id) const override;
  std::vector<records::JobRecord> jobs(const Page& page) const override;
  std::vector<records::JobRecord> unfinished() const override;
  bool set_running(bool running) override;
  std::vector<EndedJob> ended() const override;
  std::shared_ptr<const records::BlockSource> result(const std::string& job) const override;
  void expire(const std::string& job, records::Clock::time_point now) override;
  void erase_job(const std::string& id) override;

  std::optional<std::string> upload_path(const std::string& sha256,
                                         const std::string& owner) const override;
  std::string new_upload_path(std::uint64_t bytes) override;
  records::Clock::time_point keep_uploads(const std::vector<Upload>& uploads,
                                          const std::string& owner) override;
  std::optional<UploadRecord> upload(const std::string& sha256,
                                     const std::string& owner) const override;
  std::vector<UploadRecord> uploads(const std::string& owner, const std::string& after,
                                    std::size_t count) const override;
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
  DiskUsage::Reservation reserve(std::uint64_t bytes);
  void remove_unreferenced(Connection& connection);
  void save(Connection& connection, const records::MeshRecord& record, const std::string& bytes);

  template <class Read>
  auto reading(Read&& read) const {
    const std::lock_guard lock(_reader_mutex);
    return read(_reader);
  }
  std::optional<Row> row(FileKind kind, const std::string& id) const;
  std::vector<Row> page(FileKind kind, const Page& page) const;
  std::vector<UploadRecord> uploads_where(const std::string& condition, const std::string& owner,
                                          const std::string& sha256, std::size_t count) const;

  const std::string _folder;
  DiskUsage _usage;
  Files _meshes;
  Files _results;
  Files _uploads;
  UploadParts _parts;
  mutable Triangulations _triangulations;
  /// Files to which no record refers any more, or never did. Used by the thread that commits.
  std::vector<FileName> _unreferenced;
  GroupCommit _writer;
  mutable std::mutex _reader_mutex;
  mutable Connection _reader;
};

}  // namespace anticrack::store
