// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace anticrack::output {

/// A file without a name, in memory, that programs which are started do not inherit.
class MemoryFile {
 public:
  /// Throws std::system_error.
  MemoryFile();
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  int descriptor() const noexcept { return _descriptor; }
  /// The path by which this process can open it.
  std::string path() const { return "/proc/self/fd/" + std::to_string(_descriptor); }
  /// What has been written, of more than `most` bytes the last.
  std::string content(std::size_t most = std::string::npos) const;

 private:
  int _descriptor;
};

}  // namespace anticrack::output
