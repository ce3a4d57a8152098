// SPDX-License-Identifier: GPL-3.0-or-later
//
// The one place where files are written.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace anticrack::output {

/// Makes `bytes` the content of `path`, completely or not at all: temporary file in the same
/// folder, fsync, rename, fsync of the folder. On failure throws Error, removes the temporary file
/// and leaves `path` unchanged. A file that is there keeps its permissions. `keep`: what was there
/// is called backup_of(path) from then on. What target_of takes for a stream is written as one; a
/// failure of standard output is not thrown but left to print_failure().
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes,
                bool keep = false);
/// The same of text.
void write_file(const std::filesystem::path& path, std::string_view text);

/// The name of what was in `path` before: FILE~.
std::filesystem::path backup_of(const std::filesystem::path& path);

/// Throws Error if `write_file` would fail now: folder missing or read-only, path a folder,
/// existing file write-protected. For use before a long computation.
void check_writable(const std::filesystem::path& path);

/// Creates `folder` and its parents where missing. Throws Error where that fails or the folder is
/// not writable.
void make_folder(const std::filesystem::path& folder);

}  // namespace anticrack::output
