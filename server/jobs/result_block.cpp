// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/result_block.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "jobs/trace_arrays.hpp"

namespace anticrack::jobs {

namespace {

using store::BlockBuilder;

void add_history(BlockBuilder& builder, const std::string& folder,
                 const std::vector<contact::Sample>& history) {
  arrays::for_each(
      [&](const auto& row) {
        std::vector<arrays::MemberOf<const contact::Sample, decltype(row.member)>> column;
        column.reserve(history.size());
        for (const contact::Sample& sample : history)
          column.push_back(std::invoke(row.member, sample));
        builder.add(folder + std::string(row.name), column);
      },
      arrays::history<contact::Sample>);
}

/// Of a subdomain, for all loads.
struct Subdomain {
  std::span<const std::int32_t> nodes, triangles;
};

}  // namespace

std::shared_ptr<const store::Block> result_block(const operators::MeshOperator& mesh_operator,
                                                 std::vector<LiveCase>& cases) {
  BlockBuilder builder;
  bool any = false;
  bool nodes_added = false;
  for (std::size_t l = 0; l < cases.size(); ++l) {
    if (!cases[l].solved) continue;
    if (!any) {
      add_geometry(builder, mesh_operator.trace_geometry());
      any = true;
    }
    const contact::Answer& answer = cases[l].solved->answer;
    add_traces(builder, arrays::load_traces(l), answer.traces);
    add_history(builder, arrays::load_history(l), cases[l].solved->history);
    for (std::size_t i = 0; i < answer.fields.size(); ++i) {
      if (!nodes_added) {
        add_arrays(builder, arrays::field_folder(i), arrays::subdomain<Subdomain>,
                   Subdomain{answer.fields[i].nodes, mesh_operator.field_triangles(i)});
      }
      builder.add(arrays::load_fields(l) + std::to_string(i), answer.fields[i].u);
    }
    nodes_added = nodes_added || !answer.fields.empty();
    cases[l].solved.reset();
  }
  return any ? std::make_shared<const store::Block>(builder.finish()) : nullptr;
}

}  // namespace anticrack::jobs
