// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/exact_run.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "base/at_once.hpp"
#include "contact/answer.hpp"
#include "errors/errors.hpp"
#include "jobs/growth_run.hpp"
#include "jobs/probes.hpp"
#include "jobs/result_block.hpp"
#include "operators/mesh_operator.hpp"
#include "stop/stop.hpp"

namespace anticrack::jobs {

namespace {

/// A solved case whose outcome is not made yet.
struct Solved {
  contact::Answer answer;
  std::vector<contact::Sample> history;
  std::vector<double> indicator, balanced_flux;
  std::exception_ptr failure;
};

const records::JobSpec& spec_of(const PreparedCase& prepared) { return *prepared.task.job->spec; }

Solved solve(const PreparedCase& prepared, EngineCore& core) {
  Solved solved;
  const stop::Scope scope(prepared.task.job->stop.get_token());
  try {
    Recorder recorder(prepared.task, core.iterations);
    solved.answer =
        spec_of(prepared).growth
            ? grow(prepared, core, recorder)
            : prepared.task.job->mesh_operator->solve(
                  prepared.load, std::get<contact::ActiveSetOptions>(spec_of(prepared).solver),
                  false, recorder);
    solved.history = recorder.history();
  } catch (...) {
    solved.failure = std::current_exception();
  }
  return solved;
}

bool all_stopped(const std::vector<PreparedCase>& cases) {
  return std::ranges::all_of(
      cases, [](const PreparedCase& one) { return one.task.job->stop.stop_requested(); });
}

/// Whether an answer will have bounds if it converges.
bool is_bounded(const PreparedCase& prepared) {
  return !spec_of(prepared).without_bounds && !spec_of(prepared).growth;
}

/// Solves the cases. A thread that has nothing to do makes what bounds need of the mesh meanwhile.
std::vector<Solved> solve(const std::vector<PreparedCase>& cases, EngineCore& core) {
  std::vector<Solved> solved(cases.size());
  const bool ahead = base::Threads::allowed() > 1 && std::ranges::any_of(cases, is_bounded);
  base::at_once(ahead ? 2 : 1, base::Threads::allowed(), [&] {
    return [&](std::size_t part) {
      if (part == 0) {
        std::ranges::transform(cases, solved.begin(),
                               [&](const PreparedCase& one) { return solve(one, core); });
        return;
      }
      const stop::Scope scope([&cases](const stop::Look&) { return all_stopped(cases); });
      try {
        cases.front().task.job->mesh_operator->make_ready_for_bounds();
      } catch (...) {  // the first bounds try again, and tell
      }
    };
  });
  return solved;
}

/// Forces, tips and bounds are computed from fields. With growth there are none: on the mesh all
/// paths are open.
void recover_fields(const std::vector<PreparedCase>& cases, std::vector<Solved>& solved) {
  std::vector<const operators::PreparedLoad*> loads;
  std::vector<contact::Answer*> answers;
  std::vector<std::exception_ptr*> failures;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (!spec_of(cases[i]).growth && !solved[i].failure &&
        solved[i].answer.status != contact::Status::cancelled) {
      loads.push_back(&cases[i].load);
      answers.push_back(&solved[i].answer);
      failures.push_back(&solved[i].failure);
    }
  }
  if (loads.empty()) return;
  const stop::Scope scope([&cases](const stop::Look&) { return all_stopped(cases); });
  try {
    cases.front().task.job->mesh_operator->recover_fields(loads, answers);
  } catch (...) {  // without memory every load case of the block fails
    for (std::exception_ptr* failure : failures) *failure = std::current_exception();
  }
}

/// Whether there is room for the numbers of `what`; else warns.
bool fits(const LiveJob& job, std::size_t parts, std::size_t tips, const char* what,
          contact::Answer& answer) {
  if (has_room(*job.spec, job.mesh_operator->mesh().inclusions, parts, tips)) return true;
  answer.warnings.push_back(fmt::format(
      "no numbers of {0}: {1} {0} in {2} load cases do not fit in a message; make smaller jobs",
      what, tips > 0 ? tips : parts, job.spec->loads.size()));
  return false;
}

/// Fills in probes, forces on the boundary and tips.
void measure(const std::vector<PreparedCase>& cases, std::vector<Solved>& solved) {
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (solved[i].failure || spec_of(cases[i]).growth || solved[i].answer.fields.empty()) continue;
    const auto& job = *cases[i].task.job;
    try {
      const stop::Scope scope(job.stop.get_token());
      contact::Answer& answer = solved[i].answer;
      fill_probes(*job.probes, *job.mesh_operator, answer);
      std::size_t parts = job.mesh_operator->boundary_count();
      if (fits(job, parts, 0, "parts of the boundary", answer))
        job.mesh_operator->find_boundary(cases[i].load, answer);
      else
        parts = 0;
      const std::size_t tips = job.mesh_operator->tip_count();
      if (tips > 0 && fits(job, parts, tips, "tips", answer))
        job.mesh_operator->find_tips(cases[i].load, answer, job.stop.get_token());
    } catch (...) {
      solved[i].failure = std::current_exception();
    }
  }
  for (std::size_t i = 0; i < cases.size(); ++i) {  // bounds are not begun
    if (!solved[i].failure && cases[i].task.job->stop.stop_requested())
      solved[i].failure = std::make_exception_ptr(
          errors::Error(errors::Reason::cancelled, "stopped while measuring tips"));
  }
}

/// Computes the bounds from the fields.
void add_bounds(const std::vector<PreparedCase>& cases, std::vector<Solved>& solved) {
  std::vector<operators::MeshOperator::Estimate> estimates;
  std::vector<Solved*> of_estimates;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (solved[i].failure || !is_bounded(cases[i]) ||
        solved[i].answer.status != contact::Status::converged)
      continue;
    operators::MeshOperator::Estimate one{&cases[i].load, &solved[i].answer,
                                          cases[i].task.job->stop.get_token()};
    if (const auto& accuracy = spec_of(cases[i]).accuracy) {
      one.closely = accuracy->displacement.has_value();
      if (accuracy->displacement || accuracy->displacement_estimated)
        one.of_largest = accuracy->largest;
    }
    one.keep_flux = spec_of(cases[i]).balanced_flux;
    estimates.push_back(std::move(one));
    of_estimates.push_back(&solved[i]);
  }
  try {
    cases.front().task.job->mesh_operator->estimate(estimates);
  } catch (...) {  // no memory for the part that belongs to the mesh
    for (auto& one : estimates) one.failure = std::current_exception();
  }
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    of_estimates[i]->failure = estimates[i].failure;
    of_estimates[i]->indicator = std::move(estimates[i].indicator);
    of_estimates[i]->balanced_flux = std::move(estimates[i].balanced_flux);
  }
}

/// Drops what was computed on the way and not asked for.
void drop_unwanted(const std::vector<PreparedCase>& cases, std::vector<Solved>& solved) {
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const records::JobSpec& spec = spec_of(cases[i]);
    if (!spec.fields) solved[i].answer.fields.clear();
    if (!spec.indicators && !spec.accuracy) solved[i].indicator = {};
  }
}

}  // namespace

std::vector<PreparedCase> take_together(std::deque<PreparedCase>& prepared, int share) {
  constexpr std::size_t most_fields = 16;  // fields in memory at once; more are not faster
  const std::size_t most =
      std::min(most_fields, (prepared.size() + static_cast<std::size_t>(share) - 1) /
                                static_cast<std::size_t>(share));
  std::vector<PreparedCase> cases;
  do {
    cases.push_back(std::move(prepared.front()));
    prepared.pop_front();
  } while (cases.size() < most);
  return cases;
}

std::vector<EndedCase> solve_exactly(const std::vector<PreparedCase>& cases, EngineCore& core) {
  std::vector<Solved> solved = solve(cases, core);
  recover_fields(cases, solved);
  measure(cases, solved);
  add_bounds(cases, solved);
  drop_unwanted(cases, solved);
  std::vector<EndedCase> ended;
  ended.reserve(cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Task& task = cases[i].task;
    try {
      ended.push_back(
          {task, solved[i].failure
                     ? failed_case(task, solved[i].failure)
                     : solved_case(task, solved[i].answer, solved[i].history,
                                   std::move(solved[i].indicator), solved[i].balanced_flux)});
    } catch (...) {
      ended.push_back({task, failed_case(task, std::current_exception())});
    }
  }
  return ended;
}

}  // namespace anticrack::jobs
