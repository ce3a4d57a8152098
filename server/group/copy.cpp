// SPDX-License-Identifier: GPL-3.0-or-later
#include "group/copy.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <set>

#include "digest/digest.hpp"
#include "fields/walk.hpp"
#include "group/blobs.hpp"
#include "group/check.hpp"
#include "group/rows.hpp"
#include "group/tables.hpp"
#include "records/job_record.hpp"
#include "store/array_upload.hpp"
#include "store/files.hpp"
#include "store/record_codec.hpp"
#include "store/requests.hpp"
#include "store/result_file.hpp"
#include "store/schema.hpp"
#include "store/sqlite.hpp"

namespace anticrack::group {

namespace {

using errors::Error;
using errors::Reason;
using postgres::Transaction;
using postgres::Value;
using store::FileKind;
using store::Statement;

bool is_empty(Transaction& transaction) {
  return transaction
      .run("SELECT FROM meshes UNION ALL SELECT FROM jobs UNION ALL SELECT FROM blobs LIMIT 1")
      .empty();
}

Error not_empty(const postgres::Pool& pool) {
  return {Reason::invalid_argument,
          "the PostgreSQL database {} has records already: give an empty one (createdb)",
          pool.settings().address.shown()};
}

/// Records are copied as they are: both stores have the same bytes.
class Copy {
 public:
  Copy(const std::string& data, Transaction& to,
       const std::function<void(std::size_t, std::uint64_t)>& progress)
      : _data(data), _to(to), _progress(progress), _source(store::database_path(data)) {}

  void all() {
    store::require_version(_source);
    copy_meshes();
    copy_uploads();
    copy_jobs();
  }

 private:
  /// Once for all records that refer to it.
  void copy_blob(FileKind kind, const std::string& name, std::uint64_t size,
                 const ReadBytes& read) {
    if (!_blobs.insert(name).second) return;
    _bytes += size;
    write_blob(_to, kind, name, size, read);
  }

  /// Returns whether it is a .msh.
  bool copy_file(FileKind kind, const std::string& name) {
    const std::string path = store::folder_of(_data, kind) + "/" + name;
    const base::Descriptor file = store::open_to_read(path);
    if (!file) throw Error(Reason::storage, "{} is missing", path);
    const std::uint64_t size = store::file_size(file, path);
    const auto read = [&](std::uint64_t offset, std::span<std::byte> to) {
      store::read_at(file, path, offset, to);
    };
    copy_blob(kind, name, size, read);
    return store::is_msh(file, path);
  }

  void copy_meshes() {
    Statement from =
        _source.prepare("SELECT id, owner, sha256, upload, record FROM meshes ORDER BY number");
    for (; from.step(); _progress(++_records, _bytes)) {
      const std::string id = from.text(0), owner = from.text(1), sha256 = from.text(2),
                        record = from.text(4);
      if (!sha256.empty()) copy_file(FileKind::mesh, sha256);
      _to.run(
          "INSERT INTO meshes (id, owner, sha256, upload, blob, record, checksum) "
          "VALUES ($1, $2, $3, $4, nullif($3, ''), $5, $6)",
          {id, to_column(owner), to_column(sha256), to_column(from.text(3)), Value::bytes(record),
           row_checksum(id, owner, record)});
    }
  }

  void copy_uploads() {
    Statement from = _source.prepare("SELECT sha256, owner, created FROM uploads");
    for (; from.step(); _progress(++_records, _bytes)) {
      const std::string sha256 = from.text(0);
      const bool is_array = !copy_file(FileKind::upload, sha256);
      _to.run("INSERT INTO uploads (owner, sha256, created, is_array) VALUES ($1, $2, $3, $4)",
              {to_column(from.text(1)), sha256, from.integer(2), is_array});
    }
  }

  /// The name of a job's result, once that is copied; empty: it has none.
  std::string copy_result(const std::string& file, const std::string& small) {
    if (!file.empty()) copy_file(FileKind::result, file);
    if (!file.empty() || small.empty()) return file;
    std::string name =
        digest::Sha256().add(store::result_header(*store::open_result(small, "a row"))).finish();
    copy_blob(FileKind::result, name, small.size(),
              [&](std::uint64_t offset, std::span<std::byte> to) {
                std::memcpy(to.data(), small.data() + offset, to.size());
              });
    return name;
  }

  void copy_jobs() {
    Statement from = _source.prepare(
        "SELECT id, owner, request, fingerprint, coalesce(ended, 0), result, result_bytes, "
        "coalesce(small_result, ''), record FROM jobs ORDER BY number");
    for (; from.step(); _progress(++_records, _bytes)) {
      const std::string id = from.text(0), owner = to_column(from.text(1)), bytes = from.text(8);
      const records::JobRecord record = store::decode_job_record(bytes);
      std::vector<std::string> uploads = store::uploads_of(record.spec);
      std::ranges::transform(uploads, uploads.begin(), to_column);
      _to.run(
          "INSERT INTO jobs (id, owner, request, fingerprint, uploads, ended, result, "
          "result_bytes, record, checksum) VALUES ($1, $2, $3, $4, $5, nullif($6, 0), "
          "nullif($7, ''), $8, $9, $10)",
          {id, owner, to_column(from.text(2)), from.text(3), uploads, from.integer(4),
           copy_result(from.text(5), from.text(7)), from.integer(6), Value::bytes(bytes),
           row_checksum(id, record.owner, bytes)});
      if (from.integer(4) != 0) continue;
      // A claim counts the attempt. Owners take turns.
      const bool began = record.state == records::JobState::running;
      _to.run(
          "INSERT INTO queue (job, owner, mesh, class, cases, bytes, attempt, crashes, tag) "
          "SELECT $1, $2, $3, $4::smallint, $5::bigint, $6::bigint, $7::integer, $8::integer, "
          "coalesce((SELECT max(tag) + 1 FROM queue WHERE class = $4::smallint AND owner = $2), 0)",
          {id, owner, to_column(record.spec.mesh), static_cast<int>(record.spec.priority),
           record.spec.loads.size(), fields::bytes_of(record.spec),
           record.attempt - (began ? 0 : 1), record.crashes});
    }
  }

  const std::string& _data;
  Transaction& _to;
  const std::function<void(std::size_t, std::uint64_t)>& _progress;
  store::Connection _source;
  std::set<std::string> _blobs;
  std::size_t _records = 0;
  std::uint64_t _bytes = 0;
};

}  // namespace

void require_empty(postgres::Pool& pool) {
  postgres::transact(pool, [&](Transaction& transaction) {
    if (transaction.run("SELECT 1 WHERE to_regclass('anticrack.jobs') IS NULL").empty() &&
        !is_empty(transaction))
      throw not_empty(pool);
  });
}

void copy(const std::string& data, postgres::Pool& pool,
          const std::function<void(std::size_t, std::uint64_t)>& progress) {
  postgres::make_tables(pool, tables());
  postgres::transact(pool, [&](Transaction& transaction) {
    // Who reads these may; who writes waits.
    transaction.execute("LOCK TABLE meshes, jobs, uploads, blobs IN EXCLUSIVE MODE");
    if (!is_empty(transaction)) {
      if (transaction.repeated()) return;  // it was committed
      throw not_empty(pool);
    }
    Copy(data, transaction, progress).all();
    const store::CheckedStore found = check(transaction);
    if (!found.flaws.empty())
      throw Error(Reason::storage, "what was copied differs, so it was undone: {}",
                  found.flaws.front());
  });
}

}  // namespace anticrack::group
