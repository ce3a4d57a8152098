// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "mesh/codec.hpp"
#include "records/mesh_record.hpp"
#include "store/durable_store.hpp"
#include "store/record_codec.hpp"
#include "store/requests.hpp"

namespace anticrack::store {

using errors::Error;
using errors::Reason;

void DurableStore::save(Connection& connection, const records::MeshRecord& record,
                        const std::string& bytes) {
  {
    Statement select =
        connection.prepare("SELECT sha256 FROM meshes WHERE id = ? AND sha256 <> ''");
    if (select.bind(std::string_view(record.id)).step() && select.text(0) != record.sha256)
      _unreferenced.push_back({FileKind::mesh, select.text(0)});
  }
  const std::string upload = upload_of(record);
  Statement upsert = connection.prepare(
      "INSERT INTO meshes (id, owner, sha256, upload, record, checksum) "
      "VALUES (?1, ?2, ?3, ?4, ?5, crc32c(?1, ?2, ?3, ?4, ?5)) "
      "ON CONFLICT (id) DO UPDATE SET owner = excluded.owner, sha256 = excluded.sha256, "
      "upload = excluded.upload, record = excluded.record, checksum = excluded.checksum");
  upsert.bind(std::string_view(record.id))
      .bind(std::string_view(record.owner))
      .bind(std::string_view(record.sha256))
      .bind(std::string_view(upload))
      .bind_blob(bytes)
      .run();
}

void DurableStore::put(const records::MeshRecord& record) {
  const std::string bytes = encode(record);
  _writer.run([&](Connection& connection) { save(connection, record, bytes); });
}

void DurableStore::put(const records::MeshRecord& record, const mesh::Mesh& triangulation) {
  const mesh::Bytes encoded = mesh::encode(triangulation);
  require_triangulation(record, encoded);
  const std::string bytes = encode(record);
  const DiskUsage::Reservation reservation = reserve(encoded.size());
  Part part = _meshes.write(encoded);
  _writer.run([&](Connection& connection) {
    _unreferenced.push_back({FileKind::mesh, record.sha256});
    _meshes.rename(part.path(), record.sha256);
    part.release();
    _meshes.flush_names();
    save(connection, record, bytes);
  });
}

std::optional<records::MeshRecord> DurableStore::mesh(const std::string& id) const {
  const std::optional<Row> found = row(FileKind::mesh, id);
  return found ? std::optional(mesh_of(*found)) : std::nullopt;
}

std::vector<records::MeshRecord> DurableStore::meshes(const Page& asked) const {
  std::vector<records::MeshRecord> found;
  for (const Row& row : page(FileKind::mesh, asked)) found.push_back(mesh_of(row));
  return found;
}

std::size_t DurableStore::mesh_count() const {
  return reading([](Connection& connection) {
    return static_cast<std::size_t>(connection.integer("SELECT count(*) FROM meshes"));
  });
}

void DurableStore::erase_mesh(const std::string& id) {
  _writer.run([&](Connection& connection) {
    {
      Statement select = connection.prepare("SELECT sha256 FROM meshes WHERE id = ?");
      if (!select.bind(std::string_view(id)).step()) throw unknown("meshes", id);
      if (!select.text(0).empty()) _unreferenced.push_back({FileKind::mesh, select.text(0)});
    }
    connection.prepare("DELETE FROM meshes WHERE id = ?").bind(std::string_view(id)).run();
  });
}

std::shared_ptr<const mesh::Mesh> DurableStore::triangulation(const std::string& sha256) const {
  if (!is_sha256(sha256)) return nullptr;
  if (auto held = _triangulations.find(sha256)) return held;
  const std::string path = _meshes.path(sha256);
  const auto bytes = read_file(path);
  if (!bytes) return nullptr;
  if (sha256_of(*bytes) != sha256) {
    throw Error(Reason::storage,
                "the triangulation in {} is damaged: delete its mesh and make it again", path);
  }
  return _triangulations.share(sha256,
                               std::make_shared<const mesh::Mesh>(mesh::decode_mesh(*bytes)));
}

}  // namespace anticrack::store
