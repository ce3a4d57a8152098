// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/array_file.hpp"

#include <cmath>

#include "results/error.hpp"
#include "results/hdf5.hpp"
#include "results/open_file.hpp"

namespace anticrack::results {
namespace {

using hdf5::Handle;

std::vector<double> get(const Handle& group, const std::string& path, std::uint64_t budget) {
  const std::size_t slash = path.find('/');
  if (slash == std::string::npos) return hdf5::get_doubles(group, path, budget);
  if (slash == 0) return get(group, path.substr(1), budget);
  return get(hdf5::open_group(group, path.substr(0, slash)), path.substr(slash + 1), budget);
}

}  // namespace

std::vector<double> read_array(const std::filesystem::path& file, const std::string& dataset) {
  const hdf5::Quiet quiet;
  const std::string cure = "name a one-dimensional dataset of float64 in an HDF5 file";
  if (dataset.empty() || dataset.back() == '/') {
    throw Error(file.string(), "\"" + dataset + "\" names no dataset", cure);
  }
  std::vector<double> values;
  try {
    const Handle opened = hdf5::open_file(file, cure);
    const Handle root(H5Gopen2(opened.get(), "/", H5P_DEFAULT), H5Gclose, "has no root group");
    values = get(root, dataset, hdf5::memory_budget(file));
  } catch (const hdf5::Fault& fault) {
    throw Error(file.string(), fault.what(), cure);
  }
  if (values.empty()) throw Error(file.string(), "dataset " + dataset + " has no values", cure);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) {
      throw Error(file.string(),
                  "value " + std::to_string(i) + " of dataset " + dataset + " is not finite",
                  "write finite numbers");
    }
  }
  return values;
}

}  // namespace anticrack::results
