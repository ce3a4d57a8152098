// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace anticrack::app {

/// The server's folder, held by one process at a time.
class DataFolder {
 public:
  /// Makes the folder (and those above it) for its owner alone where it is not there yet. Throws
  /// ConfigError: it cannot be made or written, or another anticrackd holds it.
  explicit DataFolder(const std::string& path);
  ~DataFolder();
  DataFolder(const DataFolder&) = delete;
  DataFolder& operator=(const DataFolder&) = delete;

 private:
  int _lock = -1;
};

}  // namespace anticrack::app
