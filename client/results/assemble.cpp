// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/assemble.hpp"

#include <utility>

#include "results/assemble_sweep.hpp"
#include "results/block.hpp"
#include "results/tables.hpp"

namespace anticrack::results {
namespace {

void add_load(const Block& block, std::size_t index, std::size_t interfaces, const Mesh& mesh,
              Load& load) {
  const bool solved = load.status == Status::converged || load.status == Status::not_converged;
  load.traces.clear();
  load.fields.clear();
  load.history = {};
  if (const std::string at = arrays::load_traces(index); solved || block.has_below(at)) {
    load.traces = traces_of(block, at, interfaces);
  }
  if (const std::string at = arrays::load_history(index); solved || block.has_below(at)) {
    get_arrays(block, at, load.history, arrays::history<History>);
  }
  if (!block.has_below(arrays::load_fields(index))) return;
  for (std::size_t i = 0; i < mesh.subdomains.size(); ++i) {
    Field& field = load.fields.emplace_back();
    get_arrays(block, arrays::field_folder(i), field, arrays::subdomain<Field>);
    field.u = block.get<double>(arrays::load_fields(index) + std::to_string(i));
  }
}

}  // namespace

std::vector<Trace> traces_of(const Block& block, const std::string& at, std::size_t interfaces) {
  std::vector<Trace> traces;
  for (std::size_t i = 0; i < interfaces; ++i) {
    get_arrays(block, at + std::to_string(i) + "/", traces.emplace_back(), arrays::trace<Trace>);
  }
  return traces;
}

Result assemble(Result answers, std::span<const ArrayView> mesh_block,
                std::span<const ArrayView> result_block) {
  const Block mesh("the mesh read from the server", mesh_block);
  const Block result("the result read from the server", result_block);
  add_mesh(mesh, answers.mesh);
  for (std::size_t i = 0; i < answers.interfaces.size(); ++i) {
    get_arrays(result, arrays::interface_folder(i), answers.interfaces[i],
               arrays::interface_nodes<Interface>);
    answers.interfaces[i].edges = edges_of(mesh, answers.interfaces[i].name);
  }
  if (answers.sweep) add_sweep(result, answers);
  for (std::size_t i = 0; i < answers.loads.size() && !answers.sweep; ++i) {
    add_load(result, i, answers.interfaces.size(), answers.mesh, answers.loads[i]);
  }
  const std::string fault = first_fault(answers);
  if (!fault.empty()) result.fail(fault);
  return answers;
}

}  // namespace anticrack::results
