// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/to_result.hpp"

#include <utility>
#include <vector>

#include "results/assemble.hpp"
#include "results/entries.hpp"

namespace anticrack::cli {
namespace {

// With the defaults that the API documents.
v1::Solver with_defaults(v1::Solver solver) {
  if (!solver.has_uzawa()) {
    v1::ActiveSet& active_set = *solver.mutable_active_set();
    if (!active_set.has_tolerance()) active_set.set_tolerance(1e-12);
    if (!active_set.has_max_steps()) active_set.set_max_steps(1000);
    return solver;
  }
  v1::Uzawa& uzawa = *solver.mutable_uzawa();
  if (!uzawa.has_p()) uzawa.set_p(1e5);
  if (!uzawa.has_max_iterations()) uzawa.set_max_iterations(20000);
  if (uzawa.mass() == v1::MASS_UNSPECIFIED) uzawa.set_mass(v1::MASS_LUMPED);
  if (uzawa.has_kkt_tolerance())
    uzawa.clear_epsilon();
  else if (!uzawa.has_epsilon())
    uzawa.set_epsilon(1e-12);
  return solver;
}

// The sweep without its columns.
results::Sweep to_sweep(const Fetched& fetched) {
  results::Sweep sweep;
  for (const v1::LoadCase& load : fetched.job.spec().load_cases())
    sweep.loads.push_back(load.name());
  sweep.inclusions.assign(fetched.mesh.inclusions().begin(), fetched.mesh.inclusions().end());
  // A row beyond int32 becomes negative here, which is refused later.
  sweep.kept.assign(fetched.job.spec().sweep().traces().begin(),
                    fetched.job.spec().sweep().traces().end());
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

results::Result to_result(const Fetched& fetched) {
  results::Result result;
  result.title = fetched.job.spec().title();
  result.client_version = ANTICRACK_VERSION;
  result.server_version = fetched.server.version();
  result.job_name = fetched.job.name();
  result.not_reached = fetched.job.status().not_reached();
  result.units = fetched.job.spec().units();
  result.solver = with_defaults(fetched.job.spec().solver());
  result.mesh.info = fetched.mesh;
  if (fetched.job.spec().has_sweep())
    result.sweep = to_sweep(fetched);
  else
    result.loads = to_loads(fetched.job);
  return results::assemble(std::move(result), {fetched.mesh_block.layout, fetched.mesh_block.bytes},
                           {fetched.result_block.layout, fetched.result_block.bytes});
}

}  // namespace anticrack::cli
