// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/array_file.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "results/error.hpp"
#include "results/hdf5.hpp"
#include "results/open_file.hpp"

namespace anticrack::results {
namespace {

using hdf5::Handle;

/// Reads a dataset of a group, by its name in it and a budget of memory.
template <class Values>
using Get = std::function<Values(const Handle&, const std::string&, std::uint64_t)>;

template <class Values>
Values walk(const Handle& group, const std::string& path, std::uint64_t budget,
            const Get<Values>& get) {
  const std::size_t slash = path.find('/');
  if (slash == std::string::npos) return get(group, path, budget);
  if (slash == 0) return walk(group, path.substr(1), budget, get);
  return walk(hdf5::open_group(group, path.substr(0, slash)), path.substr(slash + 1), budget, get);
}

template <class Values>
Values read(const std::filesystem::path& file, const std::string& dataset, const std::string& cure,
            const Get<Values>& get) {
  const hdf5::Quiet quiet;
  if (dataset.empty() || dataset.back() == '/') {
    throw Error(file.string(), "\"" + dataset + "\" names no dataset", cure);
  }
  try {
    const Handle opened = hdf5::open_file(file, cure);
    const Handle root(H5Gopen2(opened.get(), "/", H5P_DEFAULT), H5Gclose, "has no root group");
    return walk(root, dataset, hdf5::memory_budget(file), get);
  } catch (const hdf5::Fault& fault) {
    throw Error(file.string(), fault.what(), cure);
  }
}

/// Index of the first value that is not finite; the size for none.
std::size_t first_odd(const std::vector<double>& values) {
  return static_cast<std::size_t>(
      std::find_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); }) -
      values.begin());
}

}  // namespace

std::vector<double> read_array(const std::filesystem::path& file, const std::string& dataset) {
  const std::string cure = "name a one-dimensional dataset of float64 in an HDF5 file";
  std::vector<double> values = read<std::vector<double>>(
      file, dataset, cure, [](const auto& group, const auto& name, std::uint64_t budget) {
        return hdf5::get_doubles(group, name, budget);
      });
  if (values.empty()) throw Error(file.string(), "dataset " + dataset + " has no values", cure);
  if (const std::size_t odd = first_odd(values); odd < values.size()) {
    throw Error(file.string(),
                "value " + std::to_string(odd) + " of dataset " + dataset + " is not finite",
                "write finite numbers");
  }
  return values;
}

Matrix read_matrix(const std::filesystem::path& file, const std::string& dataset) {
  const std::string cure = "name a two-dimensional dataset of float64 in an HDF5 file";
  hdf5::Rows rows = read<hdf5::Rows>(file, dataset, cure, hdf5::get_rows);
  if (rows.values.empty()) {
    throw Error(file.string(), "dataset " + dataset + " has no values", cure);
  }
  if (const std::size_t odd = first_odd(rows.values); odd < rows.values.size()) {
    throw Error(file.string(),
                "the value in row " + std::to_string(odd / rows.columns) + ", column " +
                    std::to_string(odd % rows.columns) + " (from 0) of dataset " + dataset +
                    " is not finite",
                "write finite numbers");
  }
  return {std::move(rows.values), rows.rows, rows.columns};
}

}  // namespace anticrack::results
