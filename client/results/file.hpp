// SPDX-License-Identifier: GPL-3.0-or-later
//
// The result file, HDF5, format "anticrack-result/1": README.md lists its contents, from
// tables.hpp. Every dataset has the attribute `units`, some have a `meaning`. Numbers are float64,
// int32 and uint8, little-endian; text is variable-length UTF-8. Readable with HDF5 1.10 or later.
#pragma once

#include <filesystem>
#include <string_view>

#include "results/compressed_mesh.hpp"
#include "results/error.hpp"
#include "results/result.hpp"

namespace anticrack::results {

inline constexpr std::string_view format = "anticrack-result/1";

/// Replaces the file completely or not at all: temporary file in the same folder, fsync, rename.
/// Needs memory for a copy of the file. Not for two threads at once unless HDF5 is thread-safe.
/// `compressed`: what compress(result.mesh) gave, or nothing; the file is the same.
void write(const std::filesystem::path& path, const Result& result,
           const CompressedMesh& compressed = {});

/// Reads a file of `format`. Throws Error for a file that is not HDF5, truncated, not a result, of
/// another format version or inconsistent. Sizes are checked before memory is allocated.
Result read(const std::filesystem::path& path);

/// Throws Error if `write` would fail now: folder missing or read-only, path a folder, existing
/// file write-protected. For use before a long computation.
void check_writable(const std::filesystem::path& path);

}  // namespace anticrack::results
