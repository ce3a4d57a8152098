// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/core.h>

#include <cstddef>
#include <exception>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "output/file.hpp"
#include "results/file.hpp"
#include "results/file_parts.hpp"
#include "results/tables.hpp"

namespace anticrack::results {
namespace {

using hdf5::create_group;
using hdf5::Handle;
using hdf5::put;
using hdf5::put_arrays;
using hdf5::put_values;

void put_load(const Handle& parent, std::size_t index, const Result& result,
              hdf5::Messages& messages, std::vector<Handle>& subdomains) {
  const Load& load = result.loads[index];
  const v1::Units& units = result.units;
  const std::string path = load_path(load.name());
  const auto put_arrays = [&](const Handle& group, std::span<const tables::Row> table,
                              const std::string& below) {
    hdf5::put_arrays(group, units, table, result.arrays, path + below);
  };
  const auto has = [&](const std::string& array) { return result.arrays.contains(path + array); };
  const Handle group = create_group(parent, load.name(), 16);
  put(group, "index", static_cast<std::int32_t>(index));
  messages.put(group, load.answer);
  put_arrays(group, tables::load, "");
  const Handle traces = create_group(group, "traces");
  for (std::size_t i = 0; has(fmt::format("traces/{}/jump", i)); ++i)
    put_arrays(create_group(traces, std::to_string(i), 8), tables::trace,
               fmt::format("traces/{}/", i));
  messages.put(group, "history", tables::history, result.arrays, path + "history/");
  if (!load.stages.empty()) {
    std::vector<const google::protobuf::Message*> stages;
    for (const v1::Stage& stage : load.stages)
      stages.insert(stages.end(), {&stage, &stage.answers(0)});
    messages.put(group, "stages", {v1::Stage::descriptor(), v1::StageAnswer::descriptor()}, stages);
  }
  if (!has("fields/0/u")) return;
  const Handle fields = create_group(group, "fields");
  for (std::size_t i = 0; has(fmt::format("fields/{}/u", i)); ++i) {
    Handle field = create_group(fields, std::to_string(i));
    put_arrays(field, tables::field, fmt::format("fields/{}/", i));
    if (i < subdomains.size()) {  // written with another load
      for (const tables::Row& row : tables::subdomain)
        hdf5::link(subdomains[i], std::string(row.name), field, std::string(row.name));
      continue;
    }
    hdf5::put_arrays(field, units, tables::subdomain, result.arrays, arrays::field_folder(i));
    subdomains.push_back(std::move(field));
  }
}

void put_sweep(const Handle& root, const Sweep& sweep, const v1::Units& units,
               hdf5::Messages& messages) {
  const Handle group = create_group(root, "sweep");
  put(group, "description", std::string("row k of every dataset belongs to load case k"));
  messages.put(group, sweep.answer);
  put_values(group, sweep, tables::sweep);
  put_arrays(group, units, tables::columns, sweep.columns, "");
}

void put_all(const Handle& root, const Result& result) {
  const v1::Units& units = result.units;
  put(root, "format", std::string(format));
  put_values(root, result, tables::result);
  hdf5::put_meanings(root, units);
  hdf5::Messages messages(units);
  messages.put(create_group(root, "units"), units);
  messages.put(create_group(root, "solver"), result.solver);
  const Handle mesh = create_group(root, "mesh");
  messages.put(mesh, result.mesh);
  put_arrays(mesh, units, tables::mesh, result.arrays, "mesh/");
  const Handle interfaces = create_group(root, "interfaces");
  for (int i = 0; i < result.mesh.interfaces_size(); ++i)
    put_arrays(create_group(interfaces, std::to_string(i)), units, tables::interface, result.arrays,
               arrays::interface_folder(static_cast<std::size_t>(i)));
  const Handle loads = create_group(root, "loads");
  std::vector<Handle> subdomains;
  for (std::size_t i = 0; i < result.loads.size(); ++i)
    put_load(loads, i, result, messages, subdomains);
  if (result.sweep) put_sweep(root, *result.sweep, units, messages);
}

/// Whether the existing file is a result of the same job or case, so that replacing it loses
/// nothing. A case does not suffice for a sweep, as it lacks the coefficients.
bool holds_the_same(const std::filesystem::path& path, const Result& result) {
  try {
    const Handle root = hdf5::open_root(path, "");
    std::string job, case_text;
    hdf5::get(root, "job", job);
    hdf5::get(root, "case", case_text);
    if (job == result.job_name) return true;
    return !case_text.empty() && case_text == result.case_text && !result.sweep &&
           !hdf5::has(root, "sweep");
  } catch (const std::exception&) {
    return false;  // not ours, or damaged
  }
}

}  // namespace

std::string write(const std::filesystem::path& path, const Result& result) {
  const std::string fault = first_fault(result);
  if (!fault.empty()) throw Error(path.string(), "the result is inconsistent: " + fault, "");
  const hdf5::Quiet quiet;
  std::vector<std::byte> bytes;
  try {
    bytes = hdf5::file_image([&](const Handle& root) { put_all(root, result); });
  } catch (const hdf5::Fault& error) {
    throw Error(path.string(), error.what(), "");
  }
  const output::Target target = output::target_of(path);
  const bool former = target.kind == output::Target::Kind::file &&
                      std::filesystem::is_regular_file(target.path) &&
                      !holds_the_same(target.path, result);
  output::write_file(path, bytes, former);
  return former ? "Kept: " + output::backup_of(target.path).string() + ", what " +
                      target.path.filename().string() + " was before"
                : "";
}

}  // namespace anticrack::results
