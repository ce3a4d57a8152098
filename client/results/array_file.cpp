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

// What a mistyped name was meant to be stands among these.
std::string missing_text(const Handle& group, const std::string& name) {
  constexpr std::size_t most = 10;
  const std::vector<std::string> names = hdf5::names_in(group);
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i) {
    list += (i == 0 ? "" : ", ") + names[i];
  }
  return "\"" + name + "\" is missing" +
         (names.empty() ? " and nothing else is there" : ", there is " + list) +
         (names.size() > most ? ", ..." : "");
}

template <class Values>
Values walk(const Handle& group, const std::string& path, std::uint64_t budget,
            const Get<Values>& get) {
  const std::size_t slash = path.find('/');
  if (slash == 0) return walk(group, path.substr(1), budget, get);
  if (const std::string name = path.substr(0, slash); !hdf5::has(group, name)) {
    throw hdf5::Fault(missing_text(group, name));
  }
  if (slash == std::string::npos) return get(group, path, budget);
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

Matrix matrix_of(const Handle& group, const std::string& name, std::uint64_t budget) {
  const hdf5::Dataset dataset =
      hdf5::open_array(group, name, ValueType::float64, budget, hdf5::any_columns);
  Matrix matrix{std::vector<double>(dataset.count()), dataset.rows, dataset.columns, {}};
  hdf5::read_values(dataset, matrix.values.data());
  if (hdf5::has_attribute(dataset.id, "loads")) {
    hdf5::get(dataset.id, "loads", matrix.loads, dataset.columns);
  }
  return matrix;
}

}  // namespace

std::vector<double> read_array(const std::filesystem::path& file, const std::string& dataset) {
  const std::string cure = "name a one-dimensional dataset of float64 in an HDF5 file";
  std::vector<double> values = read<std::vector<double>>(
      file, dataset, cure, [](const auto& group, const auto& name, std::uint64_t budget) {
        std::vector<double> found;
        hdf5::get_array(group, name, budget, 0, found);
        return found;
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
  Matrix rows = read<Matrix>(file, dataset, cure, matrix_of);
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
  return rows;
}

}  // namespace anticrack::results
