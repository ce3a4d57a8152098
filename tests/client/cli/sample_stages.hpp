// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "client/cli/sample_progress.hpp"

namespace anticrack::cli {

/// Of one load case, or two, whose bounds of the energy are this far apart, relative;
/// meshes/NUMBER.
inline v1::Stage stage(int number, std::uint64_t triangles, double error, int load_cases = 1) {
  v1::Stage stage;
  stage.set_mesh("meshes/" + std::to_string(number));
  stage.set_triangles(triangles);
  stage.set_seconds(0.25 * number);
  for (int i = 0; i < load_cases; ++i) {
    v1::StageAnswer& answer = *stage.add_answers();
    answer.set_energy(-2);
    answer.set_energy_lower(-2 - 2 * error / (1 + i));
    answer.set_energy_upper(-2);
    answer.set_error_bound_relative(0.5 * error);
    answer.set_displacement_error(10 * error / (1 + i));
  }
  return stage;
}

inline v1::WatchJobResponse stage_ended(const v1::Stage& stage) {
  v1::WatchJobResponse event;
  *event.mutable_stage_ended() = stage;
  return event;
}

/// A running job to energy = 1e-3, by the active set.
inline v1::WatchJobResponse staged_snapshot(int load_cases) {
  v1::WatchJobResponse event = snapshot(load_cases);
  v1::Job& job = *event.mutable_snapshot()->mutable_job();
  job.mutable_status()->set_attempt(1);
  job.mutable_spec()->mutable_solver()->mutable_active_set();
  job.mutable_spec()->mutable_accuracy()->set_energy(1e-3);
  for (int i = 0; i < load_cases; ++i)
    job.mutable_status()->add_answers()->set_status(v1::LoadCaseAnswer::STATUS_PENDING);
  return event;
}

}  // namespace anticrack::cli
