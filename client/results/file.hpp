// SPDX-License-Identifier: GPL-3.0-or-later
//
// The result file, HDF5, format "anticrack-result/2": client/RESULT.md lists its contents, from
// tables.hpp. Every dataset has the attribute `units`, some have a `meaning`; a list is one dataset
// of records. Numbers are float64, int32, int64 and uint8, little-endian; text is variable-length
// UTF-8. Readable with HDF5 1.10 or later.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "results/result.hpp"

namespace anticrack::results {

inline constexpr std::string_view format = "anticrack-result/2";

/// The error if a file is no result but a study, as the Python package writes it.
class IsStudy : public Error {
 public:
  using Error::Error;
};

/// Writes the file completely or not at all, as output::write_file. Needs memory for a copy of the
/// file. Two threads may not call it at once unless HDF5 is thread-safe. An existing file is kept
/// as FILE~ unless it is a result of the same job, or of the same case without a sweep. Returns a
/// sentence that says so, or an empty text if no file was kept.
std::string write(const std::filesystem::path& path, const Result& result);

/// Reads of a file of `format` what can be shown: values, sweeps, and u for the notes on it, but no
/// interfaces, histories, indicators and triangles. Throws IsStudy, or Error for a file that is not
/// HDF5, truncated, not a result, of another format version or inconsistent. Sizes are checked
/// before memory is allocated.
Result read(const std::filesystem::path& path);

/// Reads a one-dimensional float64 dataset of any HDF5 file; `dataset` is its path, as "/f" or
/// "/loads/f". Throws Error for other files, types and shapes, for an empty dataset and for values
/// that are not finite. Follows hard links only; allocates no more than the file can hold.
using ReadArray = std::function<std::vector<double>(const std::filesystem::path& file,
                                                    const std::string& dataset)>;
/// Returns a reader that keeps the last file open, since many arrays often lie in the same file.
/// The reader must not be used by several threads at once.
ReadArray array_reader();

struct Matrix {
  std::vector<double> values;  ///< row by row
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<std::string> loads;  ///< names of the columns: the attribute `loads`, if any
};

/// Reads a two-dimensional dataset with at least one row and one column; errors as of ReadArray.
Matrix read_matrix(const std::filesystem::path& file, const std::string& dataset);

}  // namespace anticrack::results
