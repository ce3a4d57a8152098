// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "store/array_upload.hpp"
#include "store/durable_store.hpp"
#include "store/record_codec.hpp"

namespace anticrack::store {

using errors::Error;
using errors::Reason;

namespace {

/// Fills in the size and the kind of the upload from its file.
void look_at(const std::string& path, UploadRecord& upload) {
  const base::Descriptor file = open_to_read(path);
  if (!file) return;
  upload.bytes = file_size(file, path);
  upload.array = !is_msh(file, path);
}

}  // namespace

std::optional<std::string> DurableStore::upload_path(const std::string& sha256,
                                                     const std::string& owner) const {
  return reading([&](Connection& connection) -> std::optional<std::string> {
    Statement select =
        connection.prepare(select_rows(FileKind::upload) + " WHERE sha256 = ? AND owner = ?");
    if (!select.bind(sha256, owner).step()) return std::nullopt;
    require_intact(row_at(select), FileKind::upload);
    return _uploads.path(sha256);
  });
}

records::Clock::time_point DurableStore::keep_uploads(const std::vector<Upload>& uploads,
                                                      const std::string& owner) {
  std::vector<std::string> flushed;  // where the bytes are on the disk
  std::vector<std::string> to_flush;
  std::vector<bool> damaged;  // whether the file that has the name already is damaged
  std::vector<Part> copies;   // of the bytes; removed at the end if they still have this name
  for (const Upload& upload : uploads) {
    require_part(upload, _uploads);
    const std::string there = sha256_of(_uploads.path(upload.sha256));
    damaged.push_back(!there.empty() && there != upload.sha256);
    if (damaged.back() || _parts.unflushed(upload.path)) {
      copies.push_back(_uploads.copy(upload.path));
      flushed.push_back(copies.back().path());
    } else {
      flushed.push_back(upload.path);
      to_flush.push_back(upload.path);
      _parts.mark_unflushed(upload.path);
    }
  }
  flush_all(to_flush);
  for (const std::string& path : to_flush) _parts.mark_flushed(path);
  const records::Clock::time_point now = records::Clock::now();
  // Link the files, so that the uploads are still there if this fails and is tried again.
  _writer.run([&](Connection& connection) {
    for (std::size_t i = 0; i < uploads.size(); ++i) {
      _unreferenced.push_back({FileKind::upload, uploads[i].sha256});
      if (damaged[i])
        _uploads.rename(flushed[i], uploads[i].sha256);
      else
        _uploads.link(flushed[i], uploads[i].sha256);
    }
    _uploads.flush_names();
    for (const Upload& upload : uploads)
      connection.run(
          "INSERT OR REPLACE INTO uploads (sha256, owner, created, checksum) "
          "VALUES (?1, ?2, ?3, crc32c(?1, ?2, ?3))",
          upload.sha256, owner, to_disk(now));
  });
  for (const Upload& upload : uploads) {
    _parts.forget(upload.path);
    const Part done(upload.path);
  }
  return now;
}

std::vector<UploadRecord> DurableStore::uploads_where(const char* comparison,
                                                      const std::string& owner,
                                                      const std::string& sha256,
                                                      std::size_t count) const {
  std::vector<UploadRecord> found;
  reading([&](Connection& connection) {
    Statement select =
        connection.prepare(std::string("SELECT sha256, created FROM uploads WHERE sha256 ") +
                           comparison + " ? AND owner = ? AND checksum IS " +
                           table_of(FileKind::upload).checksum + " ORDER BY sha256 LIMIT ?");
    select.bind(sha256, owner, static_cast<std::int64_t>(count));
    while (select.step()) found.push_back({select.text(0), owner, time_of(select.integer(1))});
  });
  for (UploadRecord& upload : found) look_at(_uploads.path(upload.id), upload);
  return found;
}

void DurableStore::erase_upload(const std::string& sha256, const std::string& owner) {
  _writer.run([&](Connection& connection) {
    const auto any = [&](const char* sql) { return connection.any(sql, sha256, owner); };
    // Jobs of other owners have uploads of their own.
    if (any("SELECT 1 FROM job_uploads r JOIN jobs j ON j.number = r.job "
            "WHERE r.upload = ? AND j.owner = ? AND j.ended IS NULL") ||
        any("SELECT 1 FROM meshes WHERE upload = ? AND owner = ? AND sha256 = ''")) {
      throw upload_in_use(sha256);
    }
    if (!any("DELETE FROM uploads WHERE sha256 = ? AND owner = ? RETURNING 1"))
      throw unknown("uploads", sha256);
    _unreferenced.push_back({FileKind::upload, sha256});
  });
}

std::size_t DurableStore::expire_uploads(records::Clock::time_point before) {
  std::size_t removed = 0;
  _writer.run([&](Connection& connection) {
    Statement erase = connection.prepare(
        "DELETE FROM uploads WHERE created < ? AND checksum IS " +
        table_of(FileKind::upload).checksum +
        " "
        "AND NOT EXISTS (SELECT 1 FROM job_uploads r JOIN jobs j ON j.number = r.job "
        "                WHERE r.upload = uploads.sha256 AND j.ended IS NULL) "
        "AND NOT EXISTS (SELECT 1 FROM meshes m "
        "                WHERE m.upload = uploads.sha256 AND m.upload <> '' AND m.sha256 = '') "
        "RETURNING sha256");
    erase.bind(to_disk(before));
    while (erase.step()) {
      _unreferenced.push_back({FileKind::upload, erase.text(0)});
      ++removed;
    }
  });
  return removed;
}

}  // namespace anticrack::store
