// SPDX-License-Identifier: GPL-3.0-or-later
//
// Receives the files of an upload stream, from the first message to the store, without transport.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "anticrack/v1/upload.pb.h"
#include "digest/digest.hpp"
#include "store/array_upload.hpp"
#include "store/files.hpp"
#include "store/store.hpp"

namespace anticrack::rpc {

/// Call accept(header), accept(chunk) ... for each file, then complete(). Blocks on the disk. After
/// a throw, or if destroyed before complete(), all temporary files are removed. Errors have the
/// file's index in metadata "file". Not thread-safe.
class UploadReceiver {
 public:
  static constexpr std::size_t max_files = 1000;

  /// The uploads will belong to `owner`.
  UploadReceiver(store::Store& store, std::string owner, std::uint64_t max_bytes);
  UploadReceiver(const UploadReceiver&) = delete;
  UploadReceiver& operator=(const UploadReceiver&) = delete;

  /// Takes a message. Stores nothing before a header within the limits, and no byte more than the
  /// header announced. Throws errors::Error: invalid_argument, limit_exceeded, disk_full, storage.
  void accept(const v1::CreateUploadsRequest& request);

  /// Keeps all files and returns them in order, if each is complete and what was announced: a mesh
  /// must begin like a format that can be read, and an array must have finite values of 8 bytes.
  /// Throws errors::Error: invalid_argument, mesh_invalid, disk_full, storage.
  std::vector<store::UploadRecord> complete();

 private:
  struct File {
    store::Part part;
    base::Descriptor file;
  };

  void begin(const v1::CreateUploadsRequest::Header& header);
  void append(const std::string& chunk);
  void end_file();
  void drop();

  store::Store& _store;
  const std::string _owner;
  const std::uint64_t _max_bytes;
  std::vector<store::Part> _complete;
  std::vector<store::UploadRecord> _records;  ///< records of these files
  std::optional<File> _file;                  ///< the file that is being received
  digest::Sha256 _hash;
  std::string _announced_sha256;
  std::uint64_t _announced_bytes = 0;
  std::optional<store::ArrayCheck> _array;  ///< for an array, not a .msh
  std::uint64_t _received_bytes = 0;
};

}  // namespace anticrack::rpc
