// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/sweep_file.hpp"

#include <string>

namespace anticrack::results {
namespace {

using hdf5::Handle;
using hdf5::put;

const std::string no_unit = "-";
constexpr std::uint64_t most_names = 1'000'000;

template <class T>
void put_column(const Handle& group, const std::string& name, const std::vector<T>& values,
                const std::string& meaning, std::size_t columns = 0) {
  const Handle dataset = hdf5::put_array(group, name, values, no_unit, columns);
  put(dataset, "meaning", meaning);
}

}  // namespace

void put_sweep(const Handle& root, const Sweep& sweep) {
  const Handle group = hdf5::create_group(root, "sweep");
  const SweepSummary counts = summary(sweep);
  put(group, "description", "row k of every dataset belongs to load case k");
  put(group, "source", sweep.source);
  put(group, "loads", sweep.loads);
  put(group, "inclusions", sweep.inclusions);
  put(group, "error", sweep.error);
  put(group, "solve_seconds", sweep.solve_seconds);
  put(group, "converged", static_cast<std::int32_t>(counts.converged));
  put(group, "not_converged", static_cast<std::int32_t>(counts.not_converged));
  put(group, "failed", static_cast<std::int32_t>(counts.failed));
  put_column(group, "status", sweep.status,
             "3 converged, 4 not converged, 5 failed, 6 cancelled; no number of a row is right but "
             "where it converged");
  put_column(group, "steps", sweep.steps, "steps of the active set");
  put_column(group, "energy", sweep.energy, "Pi(u)");
  put_column(group, "contact_length", sweep.contact_length,
             "length in contact, of all cracks and delaminated inclusions");
  put_column(group, "kkt", sweep.kkt, "largest relative residual of the optimality conditions");
  put_column(group, "kept", sweep.kept, "rows whose traces are in /loads/row-K");
  put_column(group, "contact_nodes", sweep.contact_nodes,
             "column of contact -> interface, and index of the node in its s, x, y", 2);
  // HDF5 has no chunks without extent.
  if (!sweep.inclusions.empty()) {
    put_column(group, "displacement", sweep.displacement,
               "A of each inclusion, in the order of the attribute inclusions",
               sweep.inclusions.size());
  }
  if (sweep.contacts() > 0) {
    put_column(group, "contact", sweep.contact, "1 where the node is closed under pressure",
               sweep.contacts());
  }
  if (!sweep.coefficients.empty()) {
    put_column(group, "coefficients", sweep.coefficients,
               "of each load, in the order of the attribute loads", sweep.loads.size());
  }
}

Sweep get_sweep(const Handle& root, std::uint64_t budget) {
  const Handle group = hdf5::open_group(root, "sweep");
  Sweep sweep;
  sweep.source = hdf5::get_text(group, "source");
  sweep.loads = hdf5::get_text_list(group, "loads", most_names);
  sweep.inclusions = hdf5::get_text_list(group, "inclusions", most_names);
  sweep.error = hdf5::get_text(group, "error");
  sweep.solve_seconds = hdf5::get_double(group, "solve_seconds");
  sweep.status = hdf5::get_ints(group, "status", budget);
  sweep.steps = hdf5::get_ints(group, "steps", budget);
  sweep.energy = hdf5::get_doubles(group, "energy", budget);
  sweep.contact_length = hdf5::get_doubles(group, "contact_length", budget);
  sweep.kkt = hdf5::get_doubles(group, "kkt", budget);
  sweep.kept = hdf5::get_ints(group, "kept", budget);
  sweep.contact_nodes = hdf5::get_ints(group, "contact_nodes", budget, 2);
  if (!sweep.inclusions.empty()) {
    sweep.displacement = hdf5::get_doubles(group, "displacement", budget, sweep.inclusions.size());
  }
  if (sweep.contacts() > 0) {
    sweep.contact = hdf5::get_bytes(group, "contact", budget, sweep.contacts());
  }
  if (hdf5::has(group, "coefficients")) {
    if (sweep.loads.empty()) throw hdf5::Fault("there are coefficients, but of no loads");
    sweep.coefficients = hdf5::get_doubles(group, "coefficients", budget, sweep.loads.size());
  }
  return sweep;
}

}  // namespace anticrack::results
