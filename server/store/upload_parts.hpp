// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <mutex>
#include <set>
#include <string>
#include <utility>

#include "digest/digest.hpp"
#include "errors/errors.hpp"
#include "store/disk_usage.hpp"
#include "store/files.hpp"
#include "store/store.hpp"

namespace anticrack::store {

/// Throws errors::Error unless the upload has a hash (invalid_argument) and a file of new_part()
/// (internal).
inline void require_part(const Upload& upload, const Files& files) {
  if (!digest::is_sha256(upload.sha256)) {
    throw errors::Error(errors::Reason::invalid_argument,
                        "\"{}\" is not a sha256: give its 64 lower-case hexadecimal digits",
                        upload.sha256);
  }
  if (!files.is_part(upload.path)) {
    throw errors::Error(errors::Reason::internal, "{} is not an upload on its way", upload.path);
  }
}

/// Uploads that are being received: how many bytes each may take, and which could not be flushed.
/// The receiver of an upload removes its file when it gives it up, so uploads without a file are
/// forgotten. Thread-safe.
class UploadParts {
 public:
  /// To be called when an upload begins: makes its file. `reserve` makes the reservation.
  template <class Reserve>
  std::string begin(const Files& files, const Reserve& reserve) {
    const auto reserved = [&] {
      try {
        return reserve();
      } catch (const errors::Error&) {  // lost parts may still hold room
        const std::lock_guard lock(_mutex);
        drop_lost();
        return reserve();
      }
    };
    DiskUsage::Reservation reservation = reserved();
    std::string path = files.new_part();
    const std::lock_guard lock(_mutex);
    // Looking at all uploads for each new one would take time in the square of their number.
    if (_reserved.size() >= _look_at) {
      drop_lost();
      _look_at = 2 * _reserved.size() + 16;
    }
    _reserved.emplace(path, std::move(reservation));
    return path;
  }
  /// To be called when an upload has ended.
  void forget(const std::string& path) {
    const std::lock_guard lock(_mutex);
    _reserved.erase(path);
    _unflushed.erase(path);
  }
  /// Marks a file whose flush failed: the system may have dropped the bytes and would call the next
  /// flush a success, so they must be written again.
  void mark_unflushed(const std::string& path) {
    const std::lock_guard lock(_mutex);
    _unflushed.insert(path);
  }
  /// To be called when the file was written again.
  void mark_flushed(const std::string& path) {
    const std::lock_guard lock(_mutex);
    _unflushed.erase(path);
  }
  /// Whether the file has to be written again.
  bool unflushed(const std::string& path) const {
    const std::lock_guard lock(_mutex);
    return _unflushed.contains(path);
  }

 private:
  void drop_lost() {
    std::erase_if(_reserved, [](const auto& item) { return !file_size(item.first); });
    std::erase_if(_unflushed, [](const auto& path) { return !file_size(path); });
  }

  mutable std::mutex _mutex;
  std::map<std::string, DiskUsage::Reservation> _reserved;
  std::set<std::string> _unflushed;
  std::size_t _look_at = 16;  // number of reservations at which to look for lost uploads next
};

}  // namespace anticrack::store
