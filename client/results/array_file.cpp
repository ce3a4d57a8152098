// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "results/hdf5.hpp"
#include "results/result.hpp"

namespace anticrack::results {
namespace {

using hdf5::Handle;

// Lists the names that the group has, as the missing one may be mistyped.
std::string missing_text(const Handle& group, const std::string& name) {
  const std::vector<std::string> names = hdf5::names_in(group);
  return "\"" + name + "\" is missing" +
         (names.empty() ? " and nothing else is there" : ", there is " + hdf5::listed(names));
}

/// Opens the dataset at a path below a group.
hdf5::Dataset open_below(const Handle& group, const std::string& path, std::uint64_t budget,
                         const char* shape) {
  const std::size_t slash = path.find('/');
  if (slash == 0) return open_below(group, path.substr(1), budget, shape);
  const std::string name = path.substr(0, slash);
  if (!hdf5::has(group, name)) throw hdf5::Fault(missing_text(group, name));
  Extents any;
  if (slash == std::string::npos)
    return hdf5::open_array(group, name, hdf5::type_of(ValueType::float64), budget, shape, any);
  return open_below(hdf5::open_group(group, name), path.substr(slash + 1), budget, shape);
}

struct OpenFile {
  std::filesystem::path path;
  Handle root;
};

/// A matrix may have the attribute `loads`. `open` is the file that was read last.
Matrix read(std::optional<OpenFile>& open, const std::filesystem::path& file,
            const std::string& path, bool is_matrix) {
  const std::string cure = std::string("name a ") + (is_matrix ? "two" : "one") +
                           "-dimensional dataset of float64 in an HDF5 file";
  const hdf5::Quiet quiet;
  if (path.empty() || path.back() == '/')
    throw Error(file.string(), "\"" + path + "\" names no dataset", cure);
  Matrix matrix;
  try {
    if (!open || open->path != file) {
      open.reset();
      open.emplace(OpenFile{file, hdf5::open_root(file, cure)});
    }
    const hdf5::Dataset dataset =
        open_below(open->root, path, hdf5::memory_budget(file), is_matrix ? "rows,columns" : "n");
    matrix = {
        std::vector<double>(count_of(dataset.shape)), dataset.shape[0], dataset.shape.back(), {}};
    hdf5::read_values(dataset, matrix.values.data());
    if (is_matrix && hdf5::has_attribute(dataset.id, "loads"))
      hdf5::get(dataset.id, "loads", matrix.loads, matrix.columns);
  } catch (const hdf5::Fault& fault) {
    throw Error(file.string(), fault.what(), cure);
  }
  if (matrix.values.empty()) throw Error(file.string(), "dataset " + path + " has no values", cure);
  const auto odd =
      std::ranges::find_if_not(matrix.values, [](double v) { return std::isfinite(v); });
  if (odd != matrix.values.end()) {
    const auto index = static_cast<std::size_t>(odd - matrix.values.begin());
    const std::string which = is_matrix
                                  ? fmt::format("the value in row {}, column {} (from 0)",
                                                index / matrix.columns, index % matrix.columns)
                                  : fmt::format("value {}", index);
    throw Error(file.string(), which + " of dataset " + path + " is not finite",
                "write finite numbers");
  }
  return matrix;
}

}  // namespace

ReadArray array_reader() {
  return [open = std::make_shared<std::optional<OpenFile>>()](const std::filesystem::path& file,
                                                              const std::string& dataset) {
    return read(*open, file, dataset, false).values;
  };
}

Matrix read_matrix(const std::filesystem::path& file, const std::string& dataset) {
  std::optional<OpenFile> none;
  return read(none, file, dataset, true);
}

}  // namespace anticrack::results
