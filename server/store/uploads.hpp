// SPDX-License-Identifier: GPL-3.0-or-later
//
// Uploaded files, each under the sha256 of its content.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace anticrack::store {

/// Files in one folder. A name with 64 hexadecimal digits is complete; "part-..." is on its way.
/// Thread-safe: every change is one system call.
class Uploads {
 public:
  /// Makes the folder where it is missing and removes left-over parts.
  /// Throws errors::Error (storage).
  explicit Uploads(std::filesystem::path folder);

  std::optional<std::string> path(const std::string& sha256) const;
  /// A new empty file. Throws errors::Error (storage).
  std::string new_part() const;
  /// Flushes the part to the disk, then gives it its final name. Throws errors::Error (storage,
  /// invalid_argument for what is no hash).
  void keep(const std::string& part, const std::string& sha256) const;

 private:
  std::filesystem::path _folder;
};

}  // namespace anticrack::store
