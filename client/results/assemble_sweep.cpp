// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/assemble_sweep.hpp"

#include <functional>
#include <utility>

#include "results/tables.hpp"

namespace anticrack::results {
namespace {

/// Runs of nodes in contact, from the first to the last of each.
void add_contact_intervals(const Interface& interface, std::size_t index, const Trace& trace,
                           std::vector<ContactInterval>& intervals) {
  for (std::size_t i = 0; i < interface.node_count() && i < trace.contact.size(); ++i) {
    if (trace.contact[i] == 0) continue;
    const bool goes_on = i > 0 && trace.contact[i - 1] != 0;
    if (goes_on) {
      intervals.back().end = interface.s[i];
    } else {
      intervals.push_back({index, interface.s[i], interface.s[i]});
    }
  }
}

Load load_of(const Sweep& sweep, std::size_t row, std::vector<Trace> traces,
             const std::vector<Interface>& interfaces) {
  Load load;
  load.name = row_name(static_cast<std::int64_t>(row));
  load.status = sweep.status[row];
  load.method = "active-set";
  load.iterations = sweep.steps[row];
  load.energy = sweep.energy[row];
  load.contact_length = sweep.contact_length[row];
  const std::size_t inclusions = sweep.inclusions.size();
  for (std::size_t i = 0; i < inclusions; ++i) {
    load.inclusions.push_back(
        {sweep.inclusions[i], sweep.displacement[row * inclusions + i], unknown, unknown});
  }
  for (std::size_t i = 0; i < traces.size(); ++i) {
    add_contact_intervals(interfaces[i], i, traces[i], load.contact_intervals);
  }
  load.traces = std::move(traces);
  return load;
}

}  // namespace

void add_sweep(const Block& block, Result& result) {
  Sweep& sweep = *result.sweep;
  const std::string folder = arrays::sweep_folder();
  get_arrays(block, folder, sweep, arrays::sweep_rows<Sweep>);
  get_arrays(block, folder, sweep, arrays::sweep_contacts<Sweep>);
  arrays::for_each(
      [&](const auto& row) {
        auto& values = std::invoke(row.member, sweep);
        using Value = typename std::remove_cvref_t<decltype(values)>::value_type;
        values = block.get_rows<Value>(folder + std::string(row.name), sweep.rows());
      },
      arrays::sweep_matrices<Sweep>);
  std::vector<std::size_t> nodes;
  for (const Interface& interface : result.interfaces) nodes.push_back(interface.node_count());
  const std::string fault = first_fault(sweep, nodes);
  if (!fault.empty()) block.fail(fault);

  std::vector<std::int32_t> kept;
  for (const std::int32_t row : sweep.kept) {
    const std::string at = arrays::row_traces(static_cast<std::size_t>(row));
    if (!block.has_below(at)) continue;  // of a row that did not come to an end
    kept.push_back(row);
    result.loads.push_back(load_of(sweep, static_cast<std::size_t>(row),
                                   traces_of(block, at, result.interfaces.size()),
                                   result.interfaces));
  }
  sweep.kept = std::move(kept);
}

}  // namespace anticrack::results
