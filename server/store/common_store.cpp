// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/common_store.hpp"

#include <utility>

#include "digest/digest.hpp"
#include "errors/errors.hpp"
#include "records/job_record.hpp"
#include "records/mesh_record.hpp"

namespace anticrack::store {

using errors::Error;
using errors::Reason;

CommonStore::CommonStore(const std::string& folder, std::uint64_t disk_budget)
    : _usage(disk_budget),
      _results(folder, FileKind::result, _usage),
      _uploads(folder, FileKind::upload, _usage) {}

std::optional<records::MeshRecord> CommonStore::mesh(const std::string& id) const {
  const std::optional<Row> found = row(FileKind::mesh, id);
  return found ? std::optional(mesh_of(*found)) : std::nullopt;
}

std::vector<records::MeshRecord> CommonStore::meshes(const Page& asked) const {
  std::vector<records::MeshRecord> found;
  for (const Row& row : page(FileKind::mesh, asked)) found.push_back(mesh_of(row));
  return found;
}

std::shared_ptr<const mesh::Mesh> CommonStore::triangulation(const std::string& sha256) const {
  if (!digest::is_sha256(sha256)) return nullptr;
  if (auto held = _triangulations.find(sha256)) return held;
  const std::optional<mesh::Bytes> bytes = encoded_mesh(sha256);
  if (!bytes) return nullptr;
  if (sha256_of(*bytes) != sha256) {
    throw Error(Reason::storage,
                "the triangulation {} in the store is damaged: delete its mesh and make it again",
                sha256);
  }
  return _triangulations.share(sha256,
                               std::make_shared<const mesh::Mesh>(mesh::decode_mesh(*bytes)));
}

std::optional<records::JobRecord> CommonStore::created_before(
    const std::string& owner, const std::string& request_id, const std::string& fingerprint) const {
  const std::optional<Row> found = row_of_request(owner, request_id, fingerprint);
  return found ? std::optional(job_of(*found)) : std::nullopt;
}

std::shared_ptr<Spool> CommonStore::new_spool() {
  return std::make_shared<Spool>([this] { return _results.nameless(); },
                                 [this](std::uint64_t bytes) { return reserve(bytes); });
}

std::optional<records::JobRecord> CommonStore::job(const std::string& id) const {
  const std::optional<Row> found = row(FileKind::result, id);
  return found ? std::optional(job_of(*found)) : std::nullopt;
}

std::vector<records::JobRecord> CommonStore::jobs(const Page& asked) const {
  return jobs_of(page(FileKind::result, asked));
}

std::vector<records::JobRecord> CommonStore::unfinished() const {
  std::vector<records::JobRecord> records = jobs_of(unfinished_rows());
  std::erase_if(records,
                [](const records::JobRecord& record) { return records::ended(record.state); });
  return records;
}

std::string CommonStore::new_upload_path(std::uint64_t bytes) {
  return _parts.begin(_uploads, [&] { return reserve(bytes); });
}

std::optional<UploadRecord> CommonStore::upload(const std::string& sha256,
                                                const std::string& owner) const {
  const std::vector<UploadRecord> found = uploads_where("=", owner, sha256, 1);
  return found.empty() ? std::nullopt : std::optional(found.front());
}

std::vector<UploadRecord> CommonStore::uploads(const std::string& owner, const std::string& after,
                                               std::size_t count) const {
  return uploads_where(">", owner, after, count);
}

records::JobRecord expired_job(const Row& row, records::Clock::time_point now) {
  records::JobRecord record = read_job(row);
  if (!records::ended(record.state))
    throw Error(Reason::in_use, "jobs/{} has not ended: cancel it first", record.id);
  record.expired = now;
  record.result_bytes = 0;
  return record;
}

}  // namespace anticrack::store
