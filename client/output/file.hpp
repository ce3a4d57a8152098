// SPDX-License-Identifier: GPL-3.0-or-later
//
// The only code that writes files, and the target for which an output path stands.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace anticrack::output {

/// Makes `bytes` the content of `path`, completely or not at all: by a temporary file in the same
/// folder, fsync, rename, and fsync of the folder. On failure throws Error, removes the temporary
/// file and leaves `path` unchanged. An existing file keeps its permissions. `keep`: the old file
/// is renamed to backup_of(path). A path that target_of takes for a stream is written as a stream;
/// a failure of standard output is not thrown, but left to print_failure().
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes,
                bool keep = false);
/// The same for text.
void write_file(const std::filesystem::path& path, std::string_view text);

/// The name for the old file at `path`: FILE~.
std::filesystem::path backup_of(const std::filesystem::path& path);

/// Throws Error if `write_file` would fail now: the folder is missing or read-only, the path is a
/// folder, or the existing file is write-protected. For use before a long computation.
void check_writable(const std::filesystem::path& path);

/// Creates `folder` and its parents if they are missing. Throws Error if that fails or the folder
/// is not writable.
void make_folder(const std::filesystem::path& folder);

/// The error of a file that cannot be written, read or understood: what() is "SUBJECT: CAUSE;
/// CURE".
class Error : public std::runtime_error {
 public:
  Error(const std::string& subject, const std::string& cause, const std::string& cure)
      : std::runtime_error(subject + ": " + cause + (cure.empty() ? "" : "; " + cure)) {}
};

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
