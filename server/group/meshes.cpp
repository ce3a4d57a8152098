// SPDX-License-Identifier: GPL-3.0-or-later
#include "group/blobs.hpp"
#include "group/rows.hpp"
#include "group/store.hpp"
#include "mesh/codec.hpp"
#include "records/mesh_record.hpp"
#include "store/record_codec.hpp"
#include "store/requests.hpp"

namespace anticrack::group {

using postgres::Result;
using postgres::Value;

/// `triangulation`: its bytes, or null to keep what is there under the record's hash.
void Store::save(const records::MeshRecord& record, const std::vector<std::byte>* triangulation) {
  const std::string bytes = store::encode(record);
  const std::string owner = to_column(record.owner), upload = to_column(store::upload_of(record));
  const std::string sha256 = to_column(record.sha256);
  std::vector<std::string> removed;
  transact(_pool, [&](postgres::Transaction& transaction) {
    if (triangulation != nullptr) {
      write_blob(transaction, store::FileKind::mesh, record.sha256, triangulation->size(),
                 [&](std::uint64_t offset, std::span<std::byte> to) {
                   std::ranges::copy(std::span(*triangulation).subspan(offset, to.size()),
                                     to.begin());
                 });
    }
    if (!upload.empty()) hold_uploads(transaction, owner, {upload});
    const Result before =
        transaction.run("SELECT blob FROM meshes WHERE id = $1 FOR UPDATE", {record.id});
    transaction.run(
        "INSERT INTO meshes (id, owner, sha256, upload, blob, record, checksum) VALUES ($1, $2, "
        "$3, $4, (SELECT sha256 FROM blobs WHERE sha256 = $3), $5, $6) "
        "ON CONFLICT (id) DO UPDATE SET owner = excluded.owner, sha256 = excluded.sha256, "
        "upload = excluded.upload, blob = excluded.blob, record = excluded.record, "
        "checksum = excluded.checksum",
        {record.id, owner, sha256, upload, Value::bytes(bytes),
         row_checksum(record.id, record.owner, bytes)});
    removed = remove_unreferenced(
        transaction,
        {before.empty() || before.text(0, 0) == record.sha256 ? std::string() : before.text(0, 0)});
  });
  for (const std::string& name : removed) _triangulations.forget(name);
}

void Store::put(const records::MeshRecord& record) { save(record, nullptr); }

void Store::put(const records::MeshRecord& record, const mesh::Mesh& triangulation) {
  const mesh::Bytes encoded = mesh::encode(triangulation);
  store::require_triangulation(record, encoded);
  save(record, &encoded);
}

std::size_t Store::mesh_count() const {
  return static_cast<std::size_t>(
      postgres::query(_pool, "SELECT count(*) FROM meshes").integer(0, 0));
}

void Store::erase_mesh(const std::string& id) {
  for (const std::string& name : erase("meshes", "blob", id)) _triangulations.forget(name);
}

std::optional<mesh::Bytes> Store::encoded_mesh(const std::string& sha256) const {
  mesh::Bytes bytes;
  const auto take = [&](std::span<const std::byte> piece) {
    bytes.insert(bytes.end(), piece.begin(), piece.end());
  };
  if (read_blob(_pool, store::FileKind::mesh, sha256, take) == 0) return std::nullopt;
  return bytes;
}

}  // namespace anticrack::group
