// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace anticrack::results {

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
