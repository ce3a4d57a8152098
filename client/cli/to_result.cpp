// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/to_result.hpp"

#include <span>
#include <vector>

#include "cli/mesh_text.hpp"
#include "results/assemble.hpp"
#include "results/entries.hpp"

namespace anticrack::cli {
namespace {

results::Asked asked_of(const v1::Solver& solver) {
  // Defaults as the API documents them.
  results::Asked asked;
  if (!solver.has_uzawa()) {
    const v1::ActiveSet& active_set = solver.active_set();
    asked.method = "active-set";
    asked.tolerance = active_set.has_tolerance() ? active_set.tolerance() : 1e-12;
    return asked;
  }
  const v1::Uzawa& uzawa = solver.uzawa();
  asked.method = "uzawa";
  asked.mass = uzawa.mass() == v1::MASS_CONSISTENT ? "consistent" : "lumped";
  asked.p = uzawa.has_p() ? uzawa.p() : 1e5;
  if (uzawa.has_kkt_tolerance())
    asked.kkt_tolerance = uzawa.kkt_tolerance();
  else
    asked.epsilon = uzawa.has_epsilon() ? uzawa.epsilon() : 1e-12;
  return asked;
}

std::vector<results::ArrayView> views_of(const client::Block& block) {
  std::vector<results::ArrayView> views;
  for (const v1::ArrayLayout& array : block.layout.arrays()) {
    if (array.type() < v1::ArrayLayout::TYPE_FLOAT64 || array.type() > v1::ArrayLayout::TYPE_UINT8)
      continue;  // a type of a later version
    views.push_back(results::view(array.name(), static_cast<results::ValueType>(array.type()),
                                  {array.shape().begin(), array.shape().end()}, array.offset(),
                                  std::span(block.bytes)));
  }
  return views;
}

void add_names(const v1::Mesh& from, results::Mesh& to) {
  to.subdomains.reserve(static_cast<std::size_t>(from.subdomains_size()));
  to.tension.reserve(static_cast<std::size_t>(from.subdomains_size()));
  for (const v1::SubdomainInfo& subdomain : from.subdomains()) {
    to.subdomains.push_back(subdomain.name());
    to.tension.push_back(subdomain.tension() > 0 ? subdomain.tension() : 1);
    if (!subdomain.has_tension_law()) continue;
    to.tension_law.resize(static_cast<std::size_t>(from.subdomains_size()));
    to.tension_law[to.tension.size() - 1] = law_text(subdomain.tension_law());
  }
  to.inclusions.assign(from.inclusions().begin(), from.inclusions().end());
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
  sweep.solve_seconds = results::number_in(fetched.job.status().sweep_answer(), "solve_seconds");
  return sweep;
}

}  // namespace

std::string mesh_of(const v1::Job& job) {
  std::string mesh = job.spec().mesh();
  for (const v1::Stage& stage : job.status().stages())
    if (stage.answers_size() > 0) mesh = stage.mesh();
  return mesh;
}

results::Units to_units(const v1::Units& units) { return {units.length(), units.force()}; }

std::vector<results::Load> to_loads(const v1::Job& job) {
  std::vector<results::Load> loads;
  for (int i = 0; i < job.spec().load_cases_size(); ++i) {
    results::Load& load = loads.emplace_back();
    load.asked = asked_of(job.spec().solver());
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
  result.mesh_name = fetched.mesh.name();
  result.job_name = fetched.job.name();
  result.mesh_sha256 = fetched.mesh.sha256();
  result.not_reached = fetched.job.status().not_reached();
  result.units = to_units(fetched.job.spec().units());
  result.timings.mesh_seconds = fetched.mesh.mesh_seconds();
  result.timings.factorize_seconds = fetched.mesh.factorize_seconds();
  add_names(fetched.mesh, result.mesh);
  for (const v1::InterfaceInfo& interface : fetched.mesh.interfaces())
    result.interfaces.emplace_back().name = interface.name();
  if (fetched.job.spec().has_sweep()) {
    result.sweep = to_sweep(fetched);
    result.timings.solve_seconds = result.sweep->solve_seconds;
  } else {
    result.loads = to_loads(fetched.job);
    for (const results::Load& load : result.loads)
      result.timings.solve_seconds += results::number_in(load.answer, "solve_seconds");
  }
  return results::assemble(std::move(result), views_of(fetched.mesh_block),
                           views_of(fetched.result_block));
}

}  // namespace anticrack::cli
