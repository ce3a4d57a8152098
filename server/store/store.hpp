// SPDX-License-Identifier: GPL-3.0-or-later
//
// The data that outlive a request, a restart and a crash: records in SQLite, and meshes, results
// and uploads as files beside it.
//
//   DATA/anticrack.db (+ -wal, -shm)   records, small results; user_version is the schema's version
//   DATA/identity                      that of the database (identity.hpp)
//   DATA/meshes/SHA256                 mesh::encode of a triangulation
//   DATA/results/SHA256                a result block, its layout in front
//   DATA/uploads/SHA256                what a client uploaded
//   DATA/*/part-XXXXXX                 being written; removed at the next start
//   DATA/results, files without names  results of jobs that run (spool.hpp)
//
// A file is written under a temporary name, flushed and renamed, and its folder is flushed; only
// then a record refers to it. A record is changed in a transaction (WAL, synchronous=FULL). So at
// any moment, also after `kill -9` or a full disk, every record is whole and every file to which a
// record refers is there. Files to which no record refers are removed at the next start, if the
// database and the folder have the same identity; a folder whose database is missing, empty or of
// another store is refused.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "records/block.hpp"
#include "records/clock.hpp"
#include "store/spool.hpp"

namespace anticrack::records {
struct JobRecord;
struct MeshRecord;
}  // namespace anticrack::records

namespace anticrack::store {

class Queue;

/// A page of a list, newest first: `count` records after the one with id `after` (empty: from the
/// start); only those of `owner`, if one is given.
struct Page {
  std::string after;
  std::size_t count = 0;
  std::optional<std::string> owner;
  bool oldest_first = false;
};

/// Bytes on the disk, by kind.
struct Usage {
  std::uint64_t meshes = 0;
  std::uint64_t results = 0;
  std::uint64_t uploads = 0;
  std::uint64_t database = 0;
  /// The sum of all kinds.
  std::uint64_t total() const { return meshes + results + uploads + database; }
};

/// What one owner has in the store.
struct OwnerUsage {
  std::string owner;
  std::uint64_t jobs = 0;          ///< records, ended ones too
  std::uint64_t unfinished = 0;    ///< of these, jobs that have not ended
  std::uint64_t result_bytes = 0;  ///< results that have not expired
};

/// An ended job, for the decisions of retention (jobs/retention.hpp).
struct EndedJob {
  std::string id;
  records::Clock::time_point ended;
  std::uint64_t result_bytes = 0;  ///< 0: none, or expired
  std::string owner{};
};

/// What several servers on one store are at.
struct GroupState {
  std::uint64_t living = 0, dead = 0;      ///< servers; dead ones have not started again
  std::uint64_t waiting = 0, running = 0;  ///< jobs
  double oldest_wait = 0;                  ///< of these [s], by the store's clock
  double clock_offset = 0;                 ///< the store's clock less this machine's [s]
};

struct StoreOptions {
  std::string folder;             ///< if missing, it is made, accessible to its owner only
  std::uint64_t disk_budget = 0;  ///< bytes for all of it; 0: the disk's size is the limit
  std::string url{};              ///< of a PostgreSQL database; empty: SQLite in the folder
  /// Told how long each transaction with the database took; may be empty.
  std::function<void(std::chrono::duration<double>)> answered{};
};

/// An upload that is complete, in a file of new_upload_path().
struct Upload {
  std::string path;
  std::string sha256;
};

/// An upload that the store keeps.
struct UploadRecord {
  std::string id;  ///< sha256
  std::string owner;
  records::Clock::time_point created;  ///< when it was last sent
  std::uint64_t bytes = 0;             ///< 0: the file is gone from the disk
  bool array = false;                  ///< whether it is an array, not a .msh
};

/// Contract:
/// 1. Every method may be called from any thread and is atomic. Writers may wait for the disk.
/// 2. A method that writes returns when what it wrote is on the disk (but for put(JobRecord)); when
/// it throws errors::Error
///    (disk_full with a retry delay: no space, or budget; storage: any other failure of the disk)
///    it has written nothing, and the same call may succeed later. Nothing but a bad disk makes the
///    store unusable.
/// 3. Lists are stable under insertion; an unknown `after` throws not_found.
/// 4. A record that has changed on the disk comes as FAILED with an error (storage) that names it
/// and
///    gives the cure; no more is known of it than id and owner.
/// 5. Ids are unique for ever; an erased id does not come back by itself.
class Store {
 public:
  virtual ~Store() = default;

  virtual void put(const records::MeshRecord& record) = 0;  ///< inserts or replaces
  /// The same with the triangulation, whose encoding has the hash record.sha256.
  virtual void put(const records::MeshRecord& record, const mesh::Mesh& triangulation) = 0;
  /// Empty where there is none.
  virtual std::optional<records::MeshRecord> mesh(const std::string& id) const = 0;
  virtual std::vector<records::MeshRecord> meshes(const Page& page) const = 0;
  virtual std::size_t mesh_count() const = 0;
  /// Erases a mesh, and its triangulation if no other record has the same. Throws not_found.
  virtual void erase_mesh(const std::string& id) = 0;
  /// A triangulation: shared among all who hold it at the same time, otherwise read from the disk
  /// and checked. Null if there is none; throws storage if the file does not have its hash.
  virtual std::shared_ptr<const mesh::Mesh> triangulation(const std::string& sha256) const = 0;

  /// Inserts the job, or returns the job that its owner made with the same (non-empty) request id
  /// before; throws request_id_reused if that job had another fingerprint.
  virtual records::JobRecord create(const records::JobRecord& record,
                                    const std::string& fingerprint) = 0;
  /// The job that `create` would return in place of one with these; empty: none.
  virtual std::optional<records::JobRecord> created_before(
      const std::string& owner, const std::string& request_id,
      const std::string& fingerprint) const = 0;
  /// Replaces the record; throws not_found. It survives kill -9, and a power failure once anything
  /// was written after it; what a start and a recovery write can be found out again.
  virtual void put(const records::JobRecord& record) = 0;
  /// A spool for the result of a job that runs.
  virtual std::shared_ptr<Spool> new_spool() = 0;
  /// Writes the end of a job: its last record and its result (null: none), both or neither. The
  /// result is copied in pieces, so a spooled result takes its bytes twice until this returns.
  virtual void finish(const records::JobRecord& record,
                      std::shared_ptr<const records::BlockSource> result) = 0;
  /// Empty where there is none.
  virtual std::optional<records::JobRecord> job(const std::string& id) const = 0;
  virtual std::vector<records::JobRecord> jobs(const Page& page) const = 0;
  /// The jobs that have not ended, oldest first, to be queued at a start; without damaged records.
  virtual std::vector<records::JobRecord> unfinished() const = 0;
  /// Notes whether a server is running jobs. Returns what was noted before: true at a start means
  /// that the last server did not stop but crashed.
  virtual bool set_running(bool running) = 0;
  virtual std::vector<EndedJob> ended() const = 0;  ///< oldest end first
  /// The result of a job; null if it has none. Throws storage if its record, a small result or the
  /// layout of a large one is damaged. Does not read all of a large one, whose reader gets
  /// result_expired from PostgreSQL if it is removed meanwhile.
  virtual std::shared_ptr<const records::BlockSource> result(const std::string& job) const = 0;
  /// Removes the result of an ended job and notes the time `now`; throws not_found.
  virtual void expire(const std::string& job, records::Clock::time_point now) = 0;
  virtual void erase_job(const std::string& id) = 0;  ///< and its result; throws not_found

  /// The path of the upload with this hash that `owner` made; empty if there is none.
  /// require_intact_upload() (files.hpp) checks whether the content still has the hash.
  virtual std::optional<std::string> upload_path(const std::string& sha256,
                                                 const std::string& owner) const = 0;
  /// A fresh file to receive an upload of `bytes`; `keep_uploads` moves it to its place.
  virtual std::string new_upload_path(std::uint64_t bytes) = 0;
  /// Keeps all uploads, or none; an upload replaces the same file if that has changed on the disk.
  /// They share the waits for the disk. Returns the time of their creation.
  virtual records::Clock::time_point keep_uploads(const std::vector<Upload>& uploads,
                                                  const std::string& owner) = 0;
  /// An upload of `owner`; empty if there is none.
  virtual std::optional<UploadRecord> upload(const std::string& sha256,
                                             const std::string& owner) const = 0;
  /// At most `count` uploads of `owner`, sorted by sha256, after `after`; without damaged records.
  virtual std::vector<UploadRecord> uploads(const std::string& owner, const std::string& after,
                                            std::size_t count) const = 0;
  /// Erases an upload. Throws not_found; in_use if an unfinished job or a mesh without a
  /// triangulation of `owner` refers to it.
  virtual void erase_upload(const std::string& sha256, const std::string& owner) = 0;
  /// Removes uploads made before `before` to which no unfinished job and no mesh without a
  /// triangulation refers; returns how many.
  virtual std::size_t expire_uploads(records::Clock::time_point before) = 0;

  /// The queue that all servers on this store share; null for a store that belongs to one server,
  /// whose queue is in its memory.
  virtual Queue* queue() { return nullptr; }

  /// The bytes as counted; only for the database it asks the disk.
  virtual Usage usage() const = 0;
  /// The usage of every owner of a job. O(jobs).
  virtual std::vector<OwnerUsage> owners() const = 0;

  /// Empty for a store that belongs to one server.
  virtual std::optional<GroupState> group() const { return std::nullopt; }

  /// How long what keeps the records has been out of reach; 0: it answered last time.
  virtual std::chrono::milliseconds unreachable() const { return std::chrono::milliseconds(0); }
};

/// Opens or makes the folder. Throws errors::Error (storage): the folder cannot be written, or the
/// database is damaged, missing though there are files, not that of the files, or of another
/// version.
std::unique_ptr<Store> open(const StoreOptions& options);

}  // namespace anticrack::store
