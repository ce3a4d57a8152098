// SPDX-License-Identifier: GPL-3.0-or-later
//
// An upload from its first message to the store; knows no transport.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "anticrack/v1/mesh.pb.h"
#include "store/digest.hpp"
#include "store/store.hpp"

namespace anticrack::rpc {

/// Order: accept(header), accept(chunk) ..., complete(). Blocks on the disk. After a throw, or when
/// destroyed before complete(), the temporary file is gone. Not thread-safe.
class UploadReceiver {
 public:
  /// The upload will belong to `owner`.
  UploadReceiver(store::Store& store, std::string owner, std::uint64_t max_bytes);
  UploadReceiver(const UploadReceiver&) = delete;
  UploadReceiver& operator=(const UploadReceiver&) = delete;
  ~UploadReceiver();

  /// Nothing is stored before a header within the limits, nor a byte more than it announced.
  /// Throws errors::Error: invalid_argument, limit_exceeded, disk_full, storage.
  void accept(const v1::UploadMeshRequest& request);

  /// The upload's sha256, when it is all there and is what was announced: a .msh begins with
  /// $MeshFormat, an array is finite values of 8 bytes.
  /// Throws errors::Error: invalid_argument, mesh_invalid, disk_full, storage.
  std::string complete();

 private:
  class File;

  void begin(const v1::UploadMeshRequest::Header& header);
  void append(const std::string& chunk);

  store::Store& _store;
  const std::string _owner;
  const std::uint64_t _max_bytes;
  std::unique_ptr<File> _file;
  store::Sha256 _hash;
  std::string _announced_sha256;
  std::uint64_t _announced_bytes = 0;
  bool _is_array = false;
  std::uint64_t _received_bytes = 0;
};

}  // namespace anticrack::rpc
