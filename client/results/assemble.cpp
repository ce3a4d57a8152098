// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/assemble.hpp"

#include <utility>

#include "results/assemble_sweep.hpp"
#include "results/block.hpp"

namespace anticrack::results {
namespace {

Trace trace_of(const Block& block, const std::string& at) {
  Trace trace;
  trace.u_minus = block.get<double>(at + "/u_minus");
  trace.u_plus = block.get<double>(at + "/u_plus");
  trace.jump = block.get<double>(at + "/jump");
  trace.pressure = block.get<double>(at + "/pressure");
  trace.contact = block.get<std::int32_t>(at + "/contact");
  return trace;
}

History history_of(const Block& block, const std::string& at) {
  History history;
  history.iteration = block.get<std::int32_t>(at + "/iteration");
  history.criterion = block.get<double>(at + "/criterion");
  history.energy = block.get<double>(at + "/energy");
  history.contact_count = block.get<std::int32_t>(at + "/contact_count");
  history.kkt_equilibrium = block.get<double>(at + "/kkt_equilibrium");
  history.kkt_gap = block.get<double>(at + "/kkt_gap");
  history.kkt_sign = block.get<double>(at + "/kkt_sign");
  history.kkt_complementarity = block.get<double>(at + "/kkt_complementarity");
  return history;
}

void add_interface(const Block& block, std::size_t index, Interface& interface) {
  const std::string at = "interfaces/" + std::to_string(index);
  interface.s = block.get<double>(at + "/s");
  interface.x = block.get<double>(at + "/x");
  interface.y = block.get<double>(at + "/y");
  interface.kind = kinds_of(block.get<std::int32_t>(at + "/kind"));
}

/// A subdomain's nodes and triangles serve all loads.
Field field_of(const Block& block, const std::string& load, std::size_t subdomain,
               const Mesh& mesh) {
  const std::string at = "fields/" + std::to_string(subdomain);
  Field field;
  field.nodes = block.get<std::int32_t>(at + "/nodes");
  field.u = block.get<double>(load + "/" + at);
  if (!block.has(at + "/triangles")) {
    if (auto triangles = triangles_of(mesh, subdomain, field.nodes)) {
      field.triangles = *std::move(triangles);
      return field;
    }
  }
  field.triangles = block.get<std::int32_t>(at + "/triangles", 3);
  return field;
}

void add_load(const Block& block, std::size_t index, std::size_t interfaces, const Mesh& mesh,
              Load& load) {
  const std::string at = "loads/" + std::to_string(index);
  const bool solved = load.status == Status::converged || load.status == Status::not_converged;
  load.traces.clear();
  load.fields.clear();
  load.history = {};
  if (solved || block.has_below(at + "/traces/")) {
    load.traces = traces_of(block, at + "/traces", interfaces);
  }
  if (solved || block.has_below(at + "/history/")) {
    load.history = history_of(block, at + "/history");
  }
  if (block.has_below(at + "/fields/")) {
    for (std::size_t i = 0; i < mesh.subdomains.size(); ++i) {
      load.fields.push_back(field_of(block, at, i, mesh));
    }
  }
}

}  // namespace

std::vector<Trace> traces_of(const Block& block, const std::string& at, std::size_t interfaces) {
  std::vector<Trace> traces;
  for (std::size_t i = 0; i < interfaces; ++i) {
    traces.push_back(trace_of(block, at + "/" + std::to_string(i)));
  }
  return traces;
}

Result assemble(Result answers, std::span<const ArrayView> mesh_block,
                std::span<const ArrayView> result_block) {
  const Block mesh("the mesh read from the server", mesh_block);
  const Block result("the result read from the server", result_block);
  add_mesh(mesh, answers.mesh);
  for (std::size_t i = 0; i < answers.interfaces.size(); ++i) {
    add_interface(result, i, answers.interfaces[i]);
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
