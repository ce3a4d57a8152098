// SPDX-License-Identifier: GPL-3.0-or-later
//
// The result file, HDF5, format "anticrack-result/2": client/RESULT.md lists its contents, from
// tables.hpp. Every dataset has the attribute `units`, some have a `meaning`. Numbers are float64,
// int32 and uint8, little-endian; text is variable-length UTF-8. Readable with HDF5 1.10 or later.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "results/error.hpp"
#include "results/filtered_chunks.hpp"
#include "results/result.hpp"

namespace anticrack::results {

inline constexpr std::string_view format = "anticrack-result/2";

/// The arrays of a mesh as HDF5 keeps them, compressed, by the name of the dataset; small arrays
/// are left out.
using CompressedMesh = std::map<std::string, hdf5::FilteredChunks>;

/// Takes longer than the rest of `write` and needs no answers, so it can be done while they are
/// computed: does not call HDF5 and may run beside it on any thread. About 30 MB/s.
CompressedMesh compress(const Mesh& mesh);

/// As output::write_file, completely or not at all. Needs memory for a copy of the file. Not for
/// two threads at once unless HDF5 is thread-safe. `compressed`: what compress(result.mesh) gave,
/// or nothing; the file is the same. A file that is there and no result of the same job, or of the
/// same case without a sweep, is kept as FILE~. Returns a sentence that says so; empty: none was.
std::string write(const std::filesystem::path& path, const Result& result,
                  const CompressedMesh& compressed = {});

/// Reads a file of `format`. Throws Error for a file that is not HDF5, truncated, not a result, of
/// another format version or inconsistent. Sizes are checked before memory is allocated.
Result read(const std::filesystem::path& path);

}  // namespace anticrack::results
