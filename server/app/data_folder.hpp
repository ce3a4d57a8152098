// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "store/files.hpp"

namespace anticrack::app {

/// The server's folder, locked by one process at a time.
class DataFolder {
 public:
  /// Makes missing folders, accessible to their owner only. Throws ConfigError if the folder cannot
  /// be made or written, or if another anticrackd uses it.
  explicit DataFolder(const std::string& path);

 private:
  base::Descriptor _lock;
};

}  // namespace anticrack::app
