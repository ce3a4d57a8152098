// SPDX-License-Identifier: GPL-3.0-or-later
//
// What stores have in common, wherever their rows are.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mesh/codec.hpp"
#include "store/disk_usage.hpp"
#include "store/files.hpp"
#include "store/rows.hpp"
#include "store/store.hpp"
#include "store/triangulations.hpp"
#include "store/upload_parts.hpp"

namespace anticrack::store {

/// Reads records from rows, shares triangulations, and keeps what is on its way in a data folder.
class CommonStore : public Store {
 public:
  std::optional<records::MeshRecord> mesh(const std::string& id) const final;
  std::vector<records::MeshRecord> meshes(const Page& page) const final;
  std::shared_ptr<const mesh::Mesh> triangulation(const std::string& sha256) const final;
  std::optional<records::JobRecord> created_before(const std::string& owner,
                                                   const std::string& request_id,
                                                   const std::string& fingerprint) const final;
  std::shared_ptr<Spool> new_spool() final;
  std::optional<records::JobRecord> job(const std::string& id) const final;
  std::vector<records::JobRecord> jobs(const Page& page) const final;
  std::vector<records::JobRecord> unfinished() const final;
  std::string new_upload_path(std::uint64_t bytes) final;
  std::optional<UploadRecord> upload(const std::string& sha256,
                                     const std::string& owner) const final;
  std::vector<UploadRecord> uploads(const std::string& owner, const std::string& after,
                                    std::size_t count) const final;

 protected:
  /// The folder must be there.
  CommonStore(const std::string& folder, std::uint64_t disk_budget);

  virtual std::optional<Row> row(FileKind kind, const std::string& id) const = 0;
  virtual std::vector<Row> page(FileKind kind, const Page& page) const = 0;
  /// The job that `create` would return. Throws as require_same_request does.
  virtual std::optional<Row> row_of_request(const std::string& owner, const std::string& request_id,
                                            const std::string& fingerprint) const = 0;
  /// Jobs that have not ended, oldest first.
  virtual std::vector<Row> unfinished_rows() const = 0;
  /// The encoding of a triangulation, unchecked; none if there is none.
  virtual std::optional<mesh::Bytes> encoded_mesh(const std::string& sha256) const = 0;
  /// Uploads of `owner` of which SHA256 is comparison ("=", ">") to this one, in their order.
  virtual std::vector<UploadRecord> uploads_where(const char* comparison, const std::string& owner,
                                                  const std::string& sha256,
                                                  std::size_t count) const = 0;
  /// As DiskUsage::reserve, with all that counts.
  virtual DiskUsage::Reservation reserve(std::uint64_t bytes) { return _usage.reserve(bytes, 0); }

  mutable DiskUsage _usage;  ///< of the folder
  Files _results;
  mutable Files _uploads;
  UploadParts _parts;
  mutable Triangulations _triangulations;
};

/// The record of the job in a row with its result expired. Throws errors::Error: in_use (it has not
/// ended), and as read_job does.
records::JobRecord expired_job(const Row& row, records::Clock::time_point now);

}  // namespace anticrack::store
