// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep_input.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <string_view>
#include <utility>

namespace anticrack::cli {
namespace {

[[noreturn]] void fail(const std::string& source, const std::string& problem) {
  throw CaseError(source, problem);
}

struct Dataset {
  std::string file;
  std::string path;
};

// The dataset of "FILE.h5:/PATH"; without a path for the name of a file.
Dataset dataset_of(const std::string& name) {
  const std::size_t colon = name.rfind(":/");
  if (colon == std::string::npos || colon == 0) return {name, ""};
  return {name.substr(0, colon), name.substr(colon + 1)};
}

results::Matrix read_nodal(const std::string& name) {
  const Dataset dataset = dataset_of(name);
  if (dataset.path.empty())
    fail(name, "no dataset is named; write FILE.h5:/PATH, for example " + name + ":/f");
  return results::read_matrix(dataset.file, dataset.path);
}

// Sorts the columns into the order of the case's loads.
void sort_columns(const std::vector<std::size_t>& loads_of, results::Matrix& matrix) {
  std::vector<double> sorted(matrix.columns);
  for (std::size_t first = 0; first < matrix.values.size(); first += matrix.columns) {
    for (std::size_t j = 0; j < matrix.columns; ++j) sorted[loads_of[j]] = matrix.values[first + j];
    std::ranges::copy(sorted, matrix.values.data() + first);
  }
}

results::Matrix read_combinations(const std::string& name, const Case& the_case) {
  std::vector<std::string> loads;
  for (const v1::LoadCase& load : the_case.spec.load_cases()) loads.push_back(load.name());
  Dataset dataset = dataset_of(name);
  if (dataset.path.empty()) {
    const std::string extension = std::filesystem::path(name).extension();
    if (extension != ".h5" && extension != ".hdf5") {
      std::vector<double> values = read_coefficients(name, loads);
      const std::size_t rows = values.size() / loads.size();
      return {std::move(values), rows, loads.size(), {}};
    }
    dataset.path = "/coefficients";
  }
  results::Matrix matrix = results::read_matrix(dataset.file, dataset.path);
  const auto loads_of = loads_of_columns(
      matrix.loads, loads, [&](std::size_t) { return name + ": its attribute loads"; });
  if (matrix.columns != loads.size()) {
    fail(name, fmt::format("it has {} columns, the case {} loads; write one column for each load, "
                           "in their order, or name them in an attribute loads of the dataset",
                           matrix.columns, loads.size()));
  }
  if (loads_of.size() == matrix.columns) {
    sort_columns(loads_of, matrix);
  } else if (!loads_of.empty()) {
    fail(name, fmt::format("its attribute loads names {} of {} columns; name all of them",
                           loads_of.size(), matrix.columns));
  }
  return matrix;
}

}  // namespace

bool leave_out_accuracy(Case& the_case) {
  if (!the_case.spec.has_accuracy()) return false;
  the_case.spec.clear_accuracy();
  if (!the_case.places.contains("options.preset"))
    the_case.mesh.mutable_options()->set_preset(v1::MESH_PRESET_GRADED);
  return true;
}

SweepInput read_sweep_input(const SweepFiles& files, const Case& the_case) {
  return {files.nodal.empty() ? read_combinations(files.coefficients, the_case)
                              : read_nodal(files.nodal),
          files};
}

std::vector<std::uint32_t> select_rows(const std::string& text, std::size_t rows) {
  const auto fail = [&text](const std::string& problem) {
    throw CaseError("--traces " + text, problem);
  };
  const auto row_of = [&](std::string_view part, std::string_view item) {
    std::size_t row = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), row);
    if (end != part.data() + part.size() || error == std::errc::invalid_argument)
      fail(fmt::format("\"{}\" is not a row; write all, none, or rows, for example 0,10,20-30",
                       item));
    if (error == std::errc::result_out_of_range || row >= rows)
      fail(fmt::format("there is no row {}; rows are 0 to {}", part, rows - 1));
    return row;
  };
  std::vector<bool> chosen(rows, text == "all");
  const bool listed = rows > 0 && text != "all" && text != "none";
  for (std::size_t begin = 0; listed && begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const std::string_view item = std::string_view(text).substr(begin, comma - begin);
    const std::size_t dash = std::min(item.find('-'), item.size());
    const std::size_t first = row_of(item.substr(0, dash), item),
                      last = dash < item.size() ? row_of(item.substr(dash + 1), item) : first;
    if (last < first)
      fail(fmt::format("the range {} ends before it begins; write {}-{}", item, last, first));
    for (std::size_t row = first; row <= last; ++row) chosen[row] = true;
    begin = comma + 1;
  }
  std::vector<std::uint32_t> selected;
  for (std::size_t row = 0; row < rows; ++row)
    if (chosen[row]) selected.push_back(static_cast<std::uint32_t>(row));
  return selected;
}

void make_sweep(const SweepInput& input, Case& the_case) {
  const std::vector<std::uint32_t> traces = select_rows(input.files.traces, input.rows);
  v1::JobSpec& spec = the_case.spec;
  spec.mutable_sweep()->mutable_traces()->Add(traces.begin(), traces.end());
  spec.mutable_sweep()->set_bounds(input.files.bounds);
  spec.mutable_sweep()->set_tips(input.files.tips);
  matrix_of(input, spec);
  // Rows have no fields, but a case for `run` often asks for them.
  spec.clear_outputs();
  if (input.nodal()) {
    spec.clear_load_cases();
    the_case.force_files.clear();
  }
  the_case.places["sweep"].set_where(input.source());
  the_case.places["sweep.traces"].set_where("--traces " + input.files.traces);
}

void check_nodes(const SweepInput& input, std::uint64_t node_count) {
  if (input.columns != node_count) {
    fail(input.source(),
         fmt::format("it has {} columns, the mesh {} nodes; write f on every node, in the order of "
                     "the mesh (the dataset /mesh/nodes of a result file on it)",
                     input.columns, node_count));
  }
}

v1::Sweep::Matrix& matrix_of(const SweepInput& input, v1::JobSpec& spec) {
  v1::Sweep& sweep = *spec.mutable_sweep();
  return input.nodal() ? *sweep.mutable_nodal_forces() : *sweep.mutable_coefficients();
}

}  // namespace anticrack::cli
