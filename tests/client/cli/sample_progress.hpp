// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "cli/progress.hpp"

namespace anticrack::cli {

inline v1::WatchJobResponse snapshot(int load_cases) {
  v1::WatchJobResponse event;
  v1::Job& job = *event.mutable_snapshot()->mutable_job();
  job.set_name("jobs/1");
  job.mutable_status()->set_state(v1::JobStatus::STATE_RUNNING);
  job.mutable_spec()->mutable_solver()->mutable_uzawa()->set_epsilon(1e-12);
  for (int i = 0; i < load_cases; ++i) {
    job.mutable_spec()->add_load_cases()->set_name("load-" + std::to_string(i));
  }
  return event;
}

inline v1::WatchJobResponse sample(int load_case, int iteration, double criterion, int contact) {
  v1::WatchJobResponse event;
  v1::Samples& samples = *event.mutable_samples();
  samples.add_load_case(load_case);
  samples.add_iteration(iteration);
  samples.add_criterion(criterion);
  samples.add_contact_count(contact);
  return event;
}

inline v1::WatchJobResponse load_ended(
    int load_case, int iterations, double criterion,
    v1::LoadCaseAnswer::Status status = v1::LoadCaseAnswer::STATUS_CONVERGED) {
  v1::WatchJobResponse event;
  v1::LoadCaseEnded& ended = *event.add_load_cases_ended();
  ended.set_load_case(load_case);
  v1::LoadCaseAnswer& answer = *ended.mutable_answer();
  answer.set_status(status);
  answer.set_iterations(iterations);
  answer.set_criterion(criterion);
  answer.mutable_solve_time()->set_nanos(12'500'000);
  return event;
}

}  // namespace anticrack::cli
