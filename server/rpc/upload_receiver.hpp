// SPDX-License-Identifier: GPL-3.0-or-later
//
// The files of an upload stream, from the first message to the store; knows no transport.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "anticrack/v1/upload.pb.h"
#include "digest/digest.hpp"
#include "store/array_upload.hpp"
#include "store/store.hpp"

namespace anticrack::rpc {

/// Order: for each file accept(header), accept(chunk) ...; then complete(). Blocks on the disk.
/// After a throw, or when destroyed before complete(), all temporary files are gone. Errors name
/// the file's index in metadata "file". Not thread-safe.
class UploadReceiver {
 public:
  static constexpr std::size_t max_files = 1000;

  /// The uploads will belong to `owner`.
  UploadReceiver(store::Store& store, std::string owner, std::uint64_t max_bytes);
  UploadReceiver(const UploadReceiver&) = delete;
  UploadReceiver& operator=(const UploadReceiver&) = delete;
  ~UploadReceiver();

  /// Nothing is stored before a header within the limits, nor a byte more than it announced.
  /// Throws errors::Error: invalid_argument, limit_exceeded, disk_full, storage.
  void accept(const v1::CreateUploadsRequest& request);

  /// Keeps all files and returns them, in order, when each is all there and is what was announced:
  /// a mesh begins as one that is read does, an array is finite values of 8 bytes.
  /// Throws errors::Error: invalid_argument, mesh_invalid, disk_full, storage.
  std::vector<store::UploadRecord> complete();

 private:
  class File;

  void begin(const v1::CreateUploadsRequest::Header& header);
  void append(const std::string& chunk);
  void end_file();
  void drop();

  store::Store& _store;
  const std::string _owner;
  const std::uint64_t _max_bytes;
  std::vector<std::unique_ptr<File>> _complete;
  std::vector<store::UploadRecord> _records;  ///< of these
  std::unique_ptr<File> _file;                ///< that is being received
  digest::Sha256 _hash;
  std::string _announced_sha256;
  std::uint64_t _announced_bytes = 0;
  std::optional<store::ArrayCheck> _array;  ///< for an array, not a .msh
  std::uint64_t _received_bytes = 0;
};

}  // namespace anticrack::rpc
