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
    if (!select.bind(std::string_view(sha256)).bind(std::string_view(owner)).step()) {
      return std::nullopt;
    }
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

void DurableStore::keep_upload(const std::string& path, const std::string& sha256,
                               const std::string& owner) {
  if (!is_sha256(sha256)) {
    throw Error(Reason::invalid_argument,
                "\"" + sha256 + "\" is not a sha256: give its 64 lower-case hexadecimal digits");
  }
  if (!_uploads.is_part(path)) {
    throw Error(Reason::internal, path + " is not an upload on its way");
  }
  std::optional<Part> copy;
  const std::string there = sha256_of(_uploads.path(sha256));
  const bool damaged = !there.empty() && there != sha256;
  if (damaged || _parts.unflushed(path)) {
    copy.emplace(_uploads.copy(path));
  } else {
    _parts.mark_unflushed(path);
    flush(path);
    _parts.mark_flushed(path);
  }
  const std::string& flushed = copy ? copy->path() : path;
  const std::int64_t now = to_disk(Clock::now());
  // A link, so that the upload is still there when this fails and is tried again.
  _writer.run([&](Connection& connection) {
    _unreferenced.push_back({FileKind::upload, sha256});
    if (damaged) {
      _uploads.rename(flushed, sha256);
      copy->release();
    } else {
      _uploads.link(flushed, sha256);
    }
    _uploads.flush_names();
    connection
        .prepare(
            "INSERT OR REPLACE INTO uploads (sha256, owner, created, checksum) "
            "VALUES (?1, ?2, ?3, crc32c(?1, ?2, ?3))")
        .bind(std::string_view(sha256))
        .bind(std::string_view(owner))
        .bind(now)
        .run();
  });
  _parts.forget(path);
  const Part done(path);
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
