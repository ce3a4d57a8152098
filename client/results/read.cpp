// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "results/file.hpp"
#include "results/file_parts.hpp"
#include "results/tables.hpp"

namespace anticrack::results {
namespace {

namespace fs = std::filesystem;
using hdf5::get_arrays;
using hdf5::get_values;
using hdf5::Handle;
using hdf5::open_group;

constexpr std::size_t traces_shown = 2;  // u_minus and u_plus
static_assert(tables::trace[0].name == "u_minus" && tables::trace[1].name == "u_plus");

/// Reads arrays of each group of a list into `path`, the list's name, and its own name.
void get_each(const Handle& parent, const char* list, std::uint64_t budget,
              std::span<const tables::Row> table, Arrays& arrays, const std::string& path) {
  const Handle groups = open_group(parent, list);
  for (const std::string& name : hdf5::names_in(groups))
    get_arrays(open_group(groups, name), budget, table, arrays, path + list + "/" + name + "/");
}

/// Reads stages, whose records have the values of a stage and of its answer.
std::vector<v1::Stage> get_stages(const Handle& group, std::uint64_t budget) {
  std::vector<v1::Stage> stages;
  hdf5::get_messages(group, "stages", budget,
                     {v1::Stage::descriptor(), v1::StageAnswer::descriptor()},
                     [&]() -> google::protobuf::Message& {
                       const bool has_answer = stages.empty() || stages.back().answers_size() != 0;
                       if (has_answer) return stages.emplace_back();
                       return *stages.back().add_answers();
                     });
  return stages;
}

Load get_load(const Handle& group, std::uint64_t budget, Arrays& arrays) {
  Load load;
  hdf5::get_message(group, budget, load.answer);
  const std::string path = load_path(load.name());
  get_each(group, "traces", budget, std::span(tables::trace).first(traces_shown), arrays, path);
  if (hdf5::has(group, "fields")) get_each(group, "fields", budget, tables::field, arrays, path);
  if (hdf5::has(group, "stages")) load.stages = get_stages(group, budget);
  return load;
}

/// Reads the loads and puts them in the order of the job, as HDF5 lists groups by name.
std::vector<Load> get_loads(const Handle& root, std::uint64_t budget, Arrays& arrays) {
  const Handle list = open_group(root, "loads");
  const std::vector<std::string> names = hdf5::names_in(list);
  std::vector<Load> loads(names.size());
  std::vector<bool> filled(names.size(), false);
  for (const std::string& name : names) {
    const Handle group = open_group(list, name);
    std::int32_t number = 0;
    hdf5::get(group, "index", number);
    const auto index = static_cast<std::size_t>(number);
    if (index >= loads.size() || filled[index])
      throw hdf5::Fault("load \"" + name + "\" has the index of another or none");
    filled[index] = true;
    loads[index] = get_load(group, budget, arrays);
  }
  return loads;
}

Result get_result(const Handle& root, std::uint64_t budget) {
  Result result;
  const auto get_message = [&root, budget](const char* name, google::protobuf::Message& message) {
    Handle group = open_group(root, name);
    hdf5::get_message(group, budget, message);
    return group;
  };
  get_values(root, result, tables::result);
  get_message("units", result.units);
  get_message("solver", result.solver);
  get_arrays(get_message("mesh", result.mesh), budget, std::span(tables::mesh).first(1),
             result.arrays, "mesh/");  // the nodes
  result.loads = get_loads(root, budget, result.arrays);
  if (hdf5::has(root, "sweep")) {
    Sweep& sweep = result.sweep.emplace();
    const Handle group = get_message("sweep", sweep.answer);
    get_values(group, sweep, tables::sweep);
    get_arrays(group, budget, tables::columns, sweep.columns, "",
               {{"inclusions", sweep.inclusions.size()}, {"loads", sweep.loads.size()}});
  }
  return result;
}

/// Throws Error unless the root's attribute `format` is `format`.
void check_format(const fs::path& path, const Handle& root) {
  const char* cure = "name a file that `anticrack run -o` wrote";
  if (!hdf5::has_attribute(root, "format"))
    throw Error(path.string(), "is HDF5, but no result of anticrack", cure);
  std::string found;
  hdf5::get(root, "format", found);
  if (found == format) return;

  if (found.starts_with(format.substr(0, format.find('/') + 1))) {
    const auto version = [](std::string_view text) { return std::pair(text.size(), text); };
    throw Error(path.string(),
                "has format \"" + found + "\", this client reads \"" + std::string(format) + "\"",
                version(found) > version(format) ? "use a newer anticrack" : "run the case again");
  }
  if (found.starts_with("anticrack-study/"))
    throw IsStudy(path.string(), "is a study, no result", "see anticrack study --show");
  throw Error(path.string(), "has format \"" + found + "\", no result of anticrack", cure);
}

}  // namespace

Result read(const fs::path& path) {
  const hdf5::Quiet quiet;
  Result result;
  std::string writer;
  try {
    const Handle root =
        hdf5::open_root(path, "name a result file, as `anticrack run CASE.toml -o FILE` makes one");
    check_format(path, root);
    hdf5::get(root, "client_version", writer);
    result = get_result(root, hdf5::memory_budget(path));
    const std::string fault = first_fault(result);
    if (!fault.empty()) throw hdf5::Fault("is inconsistent: " + fault);
  } catch (const hdf5::Fault& fault) {
    throw Error(
        path.string(),
        std::string(fault.what()) + (writer.empty() ? "" : ", in a file of anticrack " + writer),
        "copy it again from where it was made, or run again");
  }
  return result;
}

}  // namespace anticrack::results
