// SPDX-License-Identifier: GPL-3.0-or-later
//
// Files in memory, for what gnuplot reads and writes: no full disk can cut them off.
#pragma once

#include <sys/types.h>
#include <string>
#include <string_view>

namespace anticrack::figures {

class MemoryFile {
 public:
  /// Throws Error where the system gives none, or takes not all of `content`.
  explicit MemoryFile(std::string_view content = {});
  MemoryFile(MemoryFile&& other) noexcept;
  MemoryFile& operator=(MemoryFile&&) = delete;
  ~MemoryFile();

  int descriptor() const noexcept { return _descriptor; }
  /// The last `most` bytes; all of them without it.
  std::string tail(off_t most = 0) const;

 private:
  int _descriptor;
};

}  // namespace anticrack::figures
