// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace anticrack::results {

/// Makes `bytes` the content of `path`: temporary file in the same folder, fsync, rename, fsync of
/// the folder. On failure throws Error, removes the temporary file and leaves `path` unchanged.
/// `keep`: what was there is called backup_of(path) from then on.
void replace_file(const std::filesystem::path& path, std::span<const std::byte> bytes,
                  bool keep = false);

/// The name of what was in `path` before: FILE~.
std::filesystem::path backup_of(const std::filesystem::path& path);

/// Creates `folder` and its parents where missing. Throws Error where that fails or the folder is
/// not writable.
void make_folder(const std::filesystem::path& folder);

}  // namespace anticrack::results
