// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>

#include "group/blobs.hpp"
#include "group/rows.hpp"
#include "group/store.hpp"
#include "store/array_upload.hpp"
#include "store/record_codec.hpp"
#include "store/requests.hpp"

namespace anticrack::group {

using errors::Error;
using errors::Reason;
using postgres::Result;

namespace {

/// SQL: whether a job that has not ended or a mesh without a triangulation of its owner needs the
/// upload u. Jobs of other owners have uploads of their own.
const std::string needed =
    "(EXISTS (SELECT FROM jobs j WHERE j.owner = u.owner AND j.ended IS NULL "
    "AND u.sha256 = ANY (j.uploads)) OR EXISTS (SELECT FROM meshes m WHERE m.owner = u.owner "
    "AND m.upload = u.sha256 AND m.upload <> '' AND m.sha256 = ''))";

}  // namespace

std::optional<std::string> Store::upload_path(const std::string& sha256,
                                              const std::string& owner) const {
  if (postgres::query(_pool, "SELECT FROM uploads WHERE sha256 = $1 AND owner = $2",
                      {to_column(sha256), to_column(owner)})
          .empty())
    return std::nullopt;
  std::string path = _uploads.path(sha256);
  if (store::file_size(path)) return path;
  store::Part part(_uploads.new_part());
  {
    const base::Descriptor file = store::open_to_write(part.path());
    std::uint64_t at = 0;
    const std::uint64_t size =
        read_blob(_pool, store::FileKind::upload, sha256, [&](std::span<const std::byte> piece) {
          store::write_at(file, part.path(), at, piece);
          at += piece.size();
        });
    if (size == 0) return std::nullopt;  // it has expired since
  }
  _uploads.rename(part.path(), sha256);
  part.release();
  return path;
}

records::Clock::time_point Store::keep_uploads(const std::vector<store::Upload>& uploads,
                                               const std::string& owner) {
  for (const store::Upload& upload : uploads) store::require_part(upload, _uploads);
  const records::Clock::time_point now = records::Clock::now();
  transact(_pool, [&](postgres::Transaction& transaction) {
    for (const store::Upload& upload : uploads) {
      const base::Descriptor file = store::open_to_read(upload.path);
      const std::uint64_t size = file ? store::file_size(file, upload.path) : 0;
      const auto read = [&](std::uint64_t offset, std::span<std::byte> to) {
        store::read_at(file, upload.path, offset, to);
      };
      if (!file) throw Error(Reason::storage, "{} is gone: upload it again", upload.path);
      write_blob(transaction, store::FileKind::upload, upload.sha256, size, read);
      transaction.run(
          "INSERT INTO uploads (owner, sha256, created, is_array) VALUES ($1, $2, $3, $4) "
          "ON CONFLICT (owner, sha256) DO UPDATE SET created = excluded.created",
          {to_column(owner), upload.sha256, store::to_disk(now),
           !store::is_msh(file, upload.path)});
    }
  });
  for (const store::Upload& upload : uploads) {
    _parts.forget(upload.path);
    store::Part done(upload.path);
    try {
      _uploads.rename(upload.path, upload.sha256);  // a copy, for who reads it soon
      done.release();
    } catch (const Error&) {
      // It is in the database, from which it will be copied.
    }
  }
  return now;
}

std::vector<store::UploadRecord> Store::uploads_where(const char* comparison,
                                                      const std::string& owner,
                                                      const std::string& sha256,
                                                      std::size_t count) const {
  const Result rows = postgres::query(
      _pool,
      std::string("SELECT sha256, created, bytes, is_array FROM uploads JOIN blobs USING (sha256) "
                  "WHERE owner = $1 AND sha256 COLLATE \"C\" ") +
          comparison + " $2 ORDER BY sha256 COLLATE \"C\" LIMIT $3",
      {to_column(owner), to_column(sha256), count});
  return rows.each([&](std::size_t row) {
    return store::UploadRecord{rows.text(row, 0), owner, store::time_of(rows.integer(row, 1)),
                               rows.count(row, 2), rows.integer(row, 3) != 0};
  });
}

void Store::erase_upload(const std::string& sha256, const std::string& owner) {
  transact(_pool, [&](postgres::Transaction& transaction) {
    const std::string of = to_column(owner), name = to_column(sha256);
    const std::string this_one = " FROM uploads u WHERE u.sha256 = $1 AND u.owner = $2";
    const bool found = !transaction.run("SELECT" + this_one + " FOR UPDATE", {name, of}).empty();
    if (!found && !transaction.repeated()) throw store::unknown("uploads", sha256);
    if (!found) return;
    if (!transaction.run("SELECT" + this_one + " AND " + needed, {name, of}).empty())
      throw store::upload_in_use(sha256);
    transaction.run("DELETE" + this_one, {name, of});
    remove_unreferenced(transaction, {name});
  });
  remove_copies();
}

std::size_t Store::expire_uploads(records::Clock::time_point before) {
  std::size_t removed = 0;
  transact(_pool, [&](postgres::Transaction& transaction) {
    // Who needs an upload holds its row: first the rows are taken, then it is seen who needs them.
    const std::string these = " FROM uploads u WHERE created < $1 AND NOT " + needed;
    const std::int64_t time = store::to_disk(before);
    transaction.run("SELECT" + these + " ORDER BY u.sha256, u.owner FOR UPDATE", {time});
    const std::vector<std::string> names =
        transaction.run("DELETE" + these + " RETURNING u.sha256", {time}).texts();
    removed = names.size();
    remove_unreferenced(transaction, names);
  });
  remove_copies();
  return removed;
}

void Store::remove_copies() {
  const std::lock_guard lock(_removing);
  const std::vector<std::string> copies = _uploads.names();
  if (copies.empty()) return;
  for (const std::string& sha256 :
       postgres::query(_pool,
                       "SELECT copy FROM unnest($1::text[]) copy WHERE NOT EXISTS "
                       "(SELECT FROM uploads WHERE sha256 = copy)",
                       {copies})
           .texts())
    _uploads.remove(sha256);
}

}  // namespace anticrack::group
