// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a path given for output stands for.
#pragma once

#include <filesystem>

namespace anticrack::output {

/// A file, which is replaced as a whole, or a stream, which is written from here to its end.
struct Target {
  enum class Kind { file, folder, stream };

  Kind kind = Kind::file;
  std::filesystem::path path;  ///< behind all symbolic links: those are written through
  int descriptor = -1;  ///< of a stream that this process has open already, as standard output

  /// By whichever name.
  bool is_standard_output() const noexcept { return kind == Kind::stream && descriptor == 1; }
};

/// "-" is standard output, and so is whatever leads to the same file: /dev/stdout, a link to it, or
/// the file it was redirected to; likewise standard error. /dev/fd/N is what this process has open
/// as N. Devices and named pipes are streams; what is not there is a file. Throws Error for a path
/// that leads round in circles, cannot be looked at, or is a disk or a socket.
Target target_of(const std::filesystem::path& path);

}  // namespace anticrack::output
