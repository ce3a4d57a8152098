// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/to_result.hpp"

#include <memory>
#include <utility>
#include <vector>

#include "results/assemble.hpp"
#include "results/entries.hpp"

namespace anticrack::cli {
namespace {

// The sweep without its columns.
results::Sweep to_sweep(const Fetched& fetched) {
  results::Sweep sweep;
  for (const v1::LoadCase& load : fetched.job.spec().load_cases())
    sweep.loads.push_back(load.name());
  sweep.inclusions.assign(fetched.mesh.inclusions().begin(), fetched.mesh.inclusions().end());
  sweep.error = fetched.job.status().error().message();
  sweep.answer = fetched.job.status().sweep_answer();
  return sweep;
}

}  // namespace

std::string mesh_of(const v1::Job& job) {
  std::string mesh = job.spec().mesh();
  for (const v1::Stage& stage : job.status().stages())
    if (stage.answers_size() > 0) mesh = stage.mesh();
  return mesh;
}

std::vector<results::Load> to_loads(const v1::Job& job) {
  std::vector<results::Load> loads;
  for (int i = 0; i < job.spec().load_cases_size(); ++i) {
    results::Load& load = loads.emplace_back();
    if (i < job.status().answers_size()) load.answer = job.status().answers(i);
    load.answer.set_name(job.spec().load_cases(i).name());
    if (!load.has_answer()) results::forget_numbers(load.answer);
    for (const v1::Stage& stage : job.status().stages()) {
      if (i >= stage.answers_size()) continue;
      load.stages.push_back(stage);
      load.stages.back().clear_answers();
      *load.stages.back().add_answers() = stage.answers(i);
    }
  }
  return loads;
}

results::Result to_result(Fetched fetched) {
  results::Result result;
  result.title = fetched.job.spec().title();
  result.client_version = ANTICRACK_VERSION;
  result.server_version = fetched.server.version();
  result.job_name = fetched.job.name();
  result.not_reached = fetched.job.status().not_reached();
  result.units = fetched.job.spec().units();
  result.solver = fetched.job.spec().solver();
  result.mesh = fetched.mesh;
  if (fetched.job.spec().has_sweep())
    result.sweep = to_sweep(fetched);
  else
    result.loads = to_loads(fetched.job);
  // A row beyond int32 becomes negative here, which is refused later.
  const auto& kept = fetched.job.spec().sweep().traces();
  const auto view = [](client::Block& block) {
    return results::BlockView{
        block.layout, std::make_shared<const std::vector<std::byte>>(std::move(block.bytes))};
  };
  return results::assemble(std::move(result), view(fetched.mesh_block), view(fetched.result_block),
                           {kept.begin(), kept.end()});
}

}  // namespace anticrack::cli
