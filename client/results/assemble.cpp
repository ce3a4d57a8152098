// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/assemble.hpp"

#include <fmt/core.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <cmath>
#include <type_traits>
#include <utility>

#include "results/block.hpp"
#include "results/entries.hpp"
#include "results/tables.hpp"

namespace anticrack::results {
namespace {

/// Reads the traces along interfaces 0, 1, ... below `at`, which ends with a slash.
std::vector<Trace> traces_of(const Block& block, const std::string& at, std::size_t interfaces) {
  std::vector<Trace> traces;
  for (std::size_t i = 0; i < interfaces; ++i)
    get_arrays(block, fmt::format("{}{}/", at, i), traces.emplace_back(), arrays::trace<Trace>);
  return traces;
}

void add_load(const Block& block, std::size_t index, std::size_t interfaces, int subdomains,
              Load& load) {
  const bool solved = load.has_answer();
  load.traces.clear();
  load.fields.clear();
  load.indicator.clear();
  load.balanced_flux.clear();
  load.membrane_rows.clear();
  load.membranes.clear();
  load.history = {};
  if (const std::string at = arrays::load_traces(index); solved || block.has_below(at))
    load.traces = traces_of(block, at, interfaces);
  if (const std::string at = arrays::load_history(index); solved || block.has_below(at))
    get_arrays(block, at, load.history, arrays::history<History>);
  get_arrays(block, arrays::load_folder(index), load, tables::of_load);
  if (!block.has_below(arrays::load_fields(index))) return;
  for (std::size_t i = 0; i < static_cast<std::size_t>(subdomains); ++i) {
    Field& field = load.fields.emplace_back();
    get_arrays(block, arrays::field_folder(i), field, arrays::subdomain<Field>);
    field.u = block.get<double>(fmt::format("{}{}", arrays::load_fields(index), i));
  }
}

/// Adds an interval for each run of consecutive nodes in contact.
void add_contact_intervals(const std::string& name, const Interface& interface, const Trace& trace,
                           v1::LoadCaseAnswer& answer) {
  for (std::size_t i = 0; i < interface.node_count() && i < trace.contact.size(); ++i) {
    if (trace.contact[i] == 0) continue;
    if (i == 0 || trace.contact[i - 1] == 0) {
      v1::ContactInterval& interval = *answer.add_contact_intervals();
      interval.set_interface(name);
      interval.set_begin(interface.s[i]);
    }
    answer.mutable_contact_intervals()->rbegin()->set_end(interface.s[i]);
  }
}

/// Sets a message's numbers to the entries at `place` of the columns with their names. A bound
/// that is NaN is not set.
template <class Table>
void set_numbers(const Sweep& sweep, std::size_t place, const Table& table,
                 google::protobuf::Message& message) {
  const auto set_number = [&message, place](std::string_view name,
                                            const std::vector<double>& column) {
    const auto* const field = message.GetDescriptor()->FindFieldByName(std::string(name));
    if (column.empty() || field == nullptr || field->cpp_type() != field->CPPTYPE_DOUBLE) return;
    if (!field->has_presence() || std::isfinite(column[place]))
      message.GetReflection()->SetDouble(&message, field, column[place]);
  };
  arrays::for_each(
      [&](const auto& row) {
        const auto& column = std::invoke(row.member, sweep);
        if constexpr (std::is_same_v<decltype(column), const std::vector<double>&>)
          set_number(row.name, column);
      },
      table);
}

/// The answer to a row, made of the sweep's columns.
v1::LoadCaseAnswer answer_of(const Sweep& sweep, std::size_t row) {
  v1::LoadCaseAnswer answer;
  forget_numbers(answer);
  answer.set_name(row_name(static_cast<std::int64_t>(row)));
  answer.set_status(static_cast<v1::LoadCaseAnswer::Status>(sweep.status[row]));
  answer.set_iterations(sweep.steps[row]);
  answer.set_energy_mesh(sweep.energy[row]);  // unless the sweep has bounds
  set_numbers(sweep, row, arrays::sweep_rows<Sweep>, answer);
  for (std::size_t i = 0; i < sweep.inclusions.size(); ++i) {
    v1::InclusionAnswer& inclusion = *answer.add_inclusions();
    forget_numbers(inclusion);
    inclusion.set_name(sweep.inclusions[i]);
    const std::size_t place = row * sweep.inclusions.size() + i;
    inclusion.set_displacement_mesh(sweep.displacement[place]);  // unless the sweep has bounds
    set_numbers(sweep, place, arrays::sweep_matrices<Sweep>, inclusion);
    for (const auto set :
         {&v1::InclusionAnswer::set_slope_x, &v1::InclusionAnswer::set_slope_x_mesh})
      (inclusion.*set)(sweep.slope_at(row, i, 0));
    for (const auto set :
         {&v1::InclusionAnswer::set_slope_y, &v1::InclusionAnswer::set_slope_y_mesh})
      (inclusion.*set)(sweep.slope_at(row, i, 1));
  }
  return answer;
}

/// Fills in the columns of result.sweep and makes the loads of its kept rows. Needs complete
/// result.interfaces. Drops rows without traces in the block from `kept`.
void add_sweep(const Block& block, Result& result) {
  Sweep& sweep = *result.sweep;
  const std::string folder = arrays::sweep_folder();
  get_arrays(block, folder, sweep, arrays::sweep_rows<Sweep>);
  get_arrays(block, folder, sweep, arrays::sweep_contacts<Sweep>);
  get_arrays(block, folder, sweep, arrays::sweep_matrices<Sweep>, sweep.rows());
  block.require(first_fault(sweep));

  std::vector<std::int32_t> kept;
  for (const std::int32_t row : sweep.kept) {
    const std::string at = arrays::row_traces(static_cast<std::size_t>(row));
    if (!block.has_below(at)) continue;  // the row did not end
    kept.push_back(row);
    Load& load = result.loads.emplace_back();
    load.answer = answer_of(sweep, static_cast<std::size_t>(row));
    load.traces = traces_of(block, at, result.interfaces.size());
    for (std::size_t i = 0; i < load.traces.size(); ++i)
      add_contact_intervals(result.mesh.info.interfaces(static_cast<int>(i)).name(),
                            result.interfaces[i], load.traces[i], load.answer);
  }
  sweep.kept = std::move(kept);
}

}  // namespace

Result assemble(Result answers, const BlockView& mesh_block, const BlockView& result_block) {
  const Block mesh("the mesh read from the server", mesh_block);
  const Block result("the result read from the server", result_block);
  get_arrays(mesh, "", answers.mesh, tables::mesh);
  answers.interfaces.resize(static_cast<std::size_t>(answers.mesh.info.interfaces_size()));
  for (std::size_t i = 0; i < answers.interfaces.size(); ++i) {
    get_arrays(result, arrays::interface_folder(i), answers.interfaces[i],
               arrays::interface_nodes<Interface>);
    get_arrays(mesh, arrays::interface_folder(i), answers.interfaces[i], tables::edges);
  }
  if (answers.sweep) add_sweep(result, answers);
  for (std::size_t i = 0; i < answers.loads.size() && !answers.sweep; ++i)
    add_load(result, i, answers.interfaces.size(), answers.mesh.info.subdomains_size(),
             answers.loads[i]);
  result.require(first_fault(answers));
  return answers;
}

}  // namespace anticrack::results
