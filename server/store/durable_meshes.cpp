// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "mesh/codec.hpp"
#include "records/mesh_record.hpp"
#include "store/durable_store.hpp"
#include "store/record_codec.hpp"
#include "store/requests.hpp"

namespace anticrack::store {

void DurableStore::save(Connection& connection, const records::MeshRecord& record,
                        const std::string& bytes) {
  {
    Statement select =
        connection.prepare("SELECT sha256 FROM meshes WHERE id = ? AND sha256 <> ''");
    if (select.bind(record.id).step() && select.text(0) != record.sha256)
      _unreferenced.push_back({FileKind::mesh, select.text(0)});
  }
  connection.run(
      "INSERT INTO meshes (id, owner, sha256, upload, record, checksum) "
      "VALUES (?1, ?2, ?3, ?4, ?5, crc32c(?1, ?2, ?3, ?4, ?5)) "
      "ON CONFLICT (id) DO UPDATE SET owner = excluded.owner, sha256 = excluded.sha256, "
      "upload = excluded.upload, record = excluded.record, checksum = excluded.checksum",
      record.id, record.owner, record.sha256, upload_of(record), Blob{bytes});
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

std::size_t DurableStore::mesh_count() const {
  return reading([](Connection& connection) {
    return static_cast<std::size_t>(connection.integer("SELECT count(*) FROM meshes"));
  });
}

void DurableStore::erase_mesh(const std::string& id) {
  _writer.run([&](Connection& connection) {
    {
      Statement select = connection.prepare("SELECT sha256 FROM meshes WHERE id = ?");
      if (!select.bind(id).step()) throw unknown("meshes", id);
      if (!select.text(0).empty()) _unreferenced.push_back({FileKind::mesh, select.text(0)});
    }
    connection.run("DELETE FROM meshes WHERE id = ?", id);
  });
}

std::optional<mesh::Bytes> DurableStore::encoded_mesh(const std::string& sha256) const {
  return read_file(_meshes.path(sha256));
}

}  // namespace anticrack::store
