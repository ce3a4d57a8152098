// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/result_block.hpp"

#include <cstdint>
#include <string>

#include "jobs/trace_arrays.hpp"

namespace anticrack::jobs {

namespace {

using store::BlockBuilder;

template <class Value, class Get>
void add_column(BlockBuilder& builder, const std::string& name,
                const std::vector<contact::Sample>& history, Get get) {
  std::vector<Value> column;
  column.reserve(history.size());
  for (const contact::Sample& sample : history) {
    column.push_back(get(sample));
  }
  builder.add(name, column);
}

void add_history(BlockBuilder& builder, const std::string& load,
                 const std::vector<contact::Sample>& history) {
  using Sample = contact::Sample;
  const std::string path = load + "history/";
  const auto integers = [&](const char* name, int Sample::*member) {
    add_column<std::int32_t>(builder, path + name, history,
                             [&](const Sample& sample) { return sample.*member; });
  };
  const auto doubles = [&](const char* name, double Sample::*member) {
    add_column<double>(builder, path + name, history,
                       [&](const Sample& sample) { return sample.*member; });
  };
  const auto residuals = [&](const char* name, double contact::KktResiduals::*member) {
    add_column<double>(builder, path + name, history,
                       [&](const Sample& sample) { return sample.kkt.*member; });
  };
  integers("iteration", &Sample::iteration);
  integers("contact_count", &Sample::contact_count);
  doubles("criterion", &Sample::criterion);
  doubles("energy", &Sample::energy);
  residuals("kkt_equilibrium", &contact::KktResiduals::equilibrium);
  residuals("kkt_gap", &contact::KktResiduals::gap);
  residuals("kkt_sign", &contact::KktResiduals::sign);
  residuals("kkt_complementarity", &contact::KktResiduals::complementarity);
}

}  // namespace

std::shared_ptr<const store::Block> result_block(const operators::MeshOperator& mesh_operator,
                                                 std::vector<LiveCase>& cases) {
  BlockBuilder builder;
  bool any = false;
  bool nodes_added = false;
  for (std::size_t l = 0; l < cases.size(); ++l) {
    if (!cases[l].solved) {
      continue;
    }
    if (!any) {
      add_geometry(builder, mesh_operator.trace_geometry());
      any = true;
    }
    const contact::Answer& answer = cases[l].solved->answer;
    const std::string load = "loads/" + std::to_string(l) + "/";
    add_traces(builder, load + "traces/", answer.traces);
    add_history(builder, load, cases[l].solved->history);
    for (std::size_t i = 0; i < answer.fields.size(); ++i) {
      const std::string subdomain = std::to_string(i);
      if (!nodes_added) {
        builder.add("fields/" + subdomain + "/nodes", answer.fields[i].nodes);
        const std::vector<std::int32_t>& triangles = mesh_operator.field_triangles(i);
        builder.add("fields/" + subdomain + "/triangles", triangles, {triangles.size() / 3, 3});
      }
      builder.add(load + "fields/" + subdomain, answer.fields[i].u);
    }
    nodes_added = nodes_added || !answer.fields.empty();
    cases[l].solved.reset();
  }
  return any ? std::make_shared<const store::Block>(builder.finish()) : nullptr;
}

}  // namespace anticrack::jobs
