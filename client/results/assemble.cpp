// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/assemble.hpp"

#include <cmath>
#include <utility>

#include "results/block.hpp"
#include "results/entries.hpp"
#include "results/tables.hpp"

namespace anticrack::results {
namespace {

/// Traces along interfaces 0, 1, ... below `at`, which ends with a slash.
std::vector<Trace> traces_of(const Block& block, const std::string& at, std::size_t interfaces) {
  std::vector<Trace> traces;
  for (std::size_t i = 0; i < interfaces; ++i)
    get_arrays(block, at + std::to_string(i) + "/", traces.emplace_back(), arrays::trace<Trace>);
  return traces;
}

void add_load(const Block& block, std::size_t index, std::size_t interfaces, const Mesh& mesh,
              Load& load) {
  const bool solved = load.has_answer();
  load.traces.clear();
  load.fields.clear();
  load.indicator.clear();
  load.history = {};
  if (const std::string at = arrays::load_traces(index); solved || block.has_below(at))
    load.traces = traces_of(block, at, interfaces);
  if (const std::string at = arrays::load_history(index); solved || block.has_below(at))
    get_arrays(block, at, load.history, arrays::history<History>);
  get_arrays(block, arrays::load_folder(index), load, tables::indicator);
  if (!block.has_below(arrays::load_fields(index))) return;
  for (std::size_t i = 0; i < mesh.subdomains.size(); ++i) {
    Field& field = load.fields.emplace_back();
    get_arrays(block, arrays::field_folder(i), field, arrays::subdomain<Field>);
    field.u = block.get<double>(arrays::load_fields(index) + std::to_string(i));
  }
}

/// Runs of consecutive nodes in contact.
void add_contact_intervals(const Interface& interface, const Trace& trace,
                           v1::LoadCaseAnswer& answer) {
  for (std::size_t i = 0; i < interface.node_count() && i < trace.contact.size(); ++i) {
    if (trace.contact[i] == 0) continue;
    if (i == 0 || trace.contact[i - 1] == 0) {
      v1::ContactInterval& interval = *answer.add_contact_intervals();
      interval.set_interface(interface.name);
      interval.set_begin(interface.s[i]);
    }
    answer.mutable_contact_intervals()->rbegin()->set_end(interface.s[i]);
  }
}

Load load_of(const Sweep& sweep, std::size_t row, std::vector<Trace> traces,
             const std::vector<Interface>& interfaces) {
  Load load;
  load.asked.method = "active-set";
  v1::LoadCaseAnswer& answer = load.answer;
  forget_numbers(answer);
  answer.set_name(row_name(static_cast<std::int64_t>(row)));
  answer.set_status(static_cast<v1::LoadCaseAnswer::Status>(sweep.status[row]));
  answer.set_iterations(sweep.steps[row]);
  answer.set_energy(sweep.energy[row]);
  answer.set_contact_length(sweep.contact_length[row]);
  const bool bounded = !sweep.energy_lower.empty() && std::isfinite(sweep.energy_lower[row]);
  if (bounded) {
    answer.set_energy_lower(sweep.energy_lower[row]);
    answer.set_energy_upper(sweep.energy_upper[row]);
  }
  const std::size_t inclusions = sweep.inclusions.size();
  for (std::size_t i = 0; i < inclusions; ++i) {
    const std::size_t place = row * inclusions + i;
    v1::InclusionAnswer& inclusion = *answer.add_inclusions();
    forget_numbers(inclusion);
    inclusion.set_name(sweep.inclusions[i]);
    inclusion.set_displacement(sweep.displacement[place]);
    inclusion.set_slope_x(sweep.slope_at(row, i, 0));
    inclusion.set_slope_y(sweep.slope_at(row, i, 1));
    if (!bounded) continue;
    inclusion.set_displacement_lower(sweep.displacement_lower[place]);
    inclusion.set_displacement_upper(sweep.displacement_upper[place]);
  }
  for (std::size_t i = 0; i < traces.size(); ++i)
    add_contact_intervals(interfaces[i], traces[i], answer);
  load.traces = std::move(traces);
  return load;
}

/// Fills in the columns of result.sweep and makes the loads of its kept rows. result.interfaces are
/// complete. Rows without traces in the block are dropped from `kept`.
void add_sweep(const Block& block, Result& result) {
  Sweep& sweep = *result.sweep;
  const std::string folder = arrays::sweep_folder();
  get_arrays(block, folder, sweep, arrays::sweep_rows<Sweep>);
  get_arrays(block, folder, sweep, arrays::sweep_contacts<Sweep>);
  get_arrays(block, folder, sweep, arrays::sweep_matrices<Sweep>, sweep.rows());
  std::vector<std::size_t> nodes;
  for (const Interface& interface : result.interfaces) nodes.push_back(interface.node_count());
  block.require(first_fault(sweep, nodes));

  std::vector<std::int32_t> kept;
  for (const std::int32_t row : sweep.kept) {
    const std::string at = arrays::row_traces(static_cast<std::size_t>(row));
    if (!block.has_below(at)) continue;  // the row did not end
    kept.push_back(row);
    result.loads.push_back(load_of(sweep, static_cast<std::size_t>(row),
                                   traces_of(block, at, result.interfaces.size()),
                                   result.interfaces));
  }
  sweep.kept = std::move(kept);
}

}  // namespace

Result assemble(Result answers, std::span<const ArrayView> mesh_block,
                std::span<const ArrayView> result_block) {
  const Block mesh("the mesh read from the server", mesh_block);
  const Block result("the result read from the server", result_block);
  get_arrays(mesh, "", answers.mesh, tables::mesh);
  for (std::size_t i = 0; i < answers.interfaces.size(); ++i) {
    get_arrays(result, arrays::interface_folder(i), answers.interfaces[i],
               arrays::interface_nodes<Interface>);
    get_arrays(mesh, arrays::interface_folder(i), answers.interfaces[i].edges, tables::edges);
  }
  if (answers.sweep) add_sweep(result, answers);
  for (std::size_t i = 0; i < answers.loads.size() && !answers.sweep; ++i)
    add_load(result, i, answers.interfaces.size(), answers.mesh, answers.loads[i]);
  result.require(first_fault(answers));
  return answers;
}

}  // namespace anticrack::results
