// SPDX-License-Identifier: GPL-3.0-or-later
//
// The only code that writes files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
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

}  // namespace anticrack::output
