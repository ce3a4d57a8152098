// SPDX-License-Identifier: GPL-3.0-or-later
//
// The target for which an output path stands.
#pragma once

#include <filesystem>

namespace anticrack::output {

/// A file, which is replaced as a whole, or a stream, which is written from its present position.
struct Target {
  enum class Kind { file, folder, stream };

  Kind kind = Kind::file;
  std::filesystem::path path;  ///< with all symbolic links resolved, as they are written through
  int descriptor = -1;  ///< of a stream that this process already has open, like standard output

  /// Whether it is standard output, by whichever name.
  bool is_standard_output() const noexcept { return kind == Kind::stream && descriptor == 1; }
};

/// "-" is standard output, and so is any path that leads to the same file: /dev/stdout, a link to
/// it, or the file to which it was redirected; likewise standard error. /dev/fd/N is the file that
/// this process has open as N. Devices and named pipes are streams; a path that does not exist is a
/// file. Throws Error for a path that is a loop of links, cannot be examined, or is a disk or a
/// socket.
Target target_of(const std::filesystem::path& path);

}  // namespace anticrack::output
