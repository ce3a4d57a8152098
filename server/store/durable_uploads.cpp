// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "store/durable_store.hpp"
#include "store/record_codec.hpp"

namespace anticrack::store {

using errors::Error;
using errors::Reason;

std::optional<std::string> DurableStore::upload_path(const std::string& sha256,
                                                     const std::string& owner) const {
  return reading([&](Connection& connection) -> std::optional<std::string> {
    Statement select =
        connection.prepare(select_rows(FileKind::upload) + " WHERE sha256 = ? AND owner = ?");
    if (!select.bind(std::string_view(sha256)).bind(std::string_view(owner)).step())
      return std::nullopt;
    require_intact(row_at(select), FileKind::upload);
    return _uploads.path(sha256);
  });
}

std::string DurableStore::new_upload_path(std::uint64_t bytes) {
  _parts.forget_lost();
  DiskUsage::Reservation reservation = reserve(bytes);
  std::string path = _uploads.new_part();
  _parts.add(path, std::move(reservation));
  return path;
}

void DurableStore::keep_uploads(const std::vector<Upload>& uploads, const std::string& owner) {
  std::vector<std::string> flushed;  // where the bytes are on the disk
  std::vector<std::string> to_flush;
  std::vector<bool> damaged;  // what has the name already
  std::vector<Part> copies;   // of the bytes, removed in the end where they still have this name
  for (const Upload& upload : uploads) {
    if (!is_sha256(upload.sha256)) {
      throw Error(
          Reason::invalid_argument,
          "\"" + upload.sha256 + "\" is not a sha256: give its 64 lower-case hexadecimal digits");
    }
    if (!_uploads.is_part(upload.path))
      throw Error(Reason::internal, upload.path + " is not an upload on its way");
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
  const std::int64_t now = to_disk(Clock::now());
  // Links, so that the uploads are still there when this fails and is tried again.
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
      connection
          .prepare(
              "INSERT OR REPLACE INTO uploads (sha256, owner, created, checksum) "
              "VALUES (?1, ?2, ?3, crc32c(?1, ?2, ?3))")
          .bind(std::string_view(upload.sha256))
          .bind(std::string_view(owner))
          .bind(now)
          .run();
  });
  for (const Upload& upload : uploads) {
    _parts.forget(upload.path);
    const Part done(upload.path);
  }
}

std::size_t DurableStore::expire_uploads(Clock::time_point before) {
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
