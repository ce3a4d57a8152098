// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/progress.hpp"

#include <fmt/core.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/text.hpp"
#include "client/jobs.hpp"

namespace anticrack::cli {

using google::protobuf::util::TimeUtil;
using Status = v1::LoadCaseAnswer::Status;

void JobProgress::apply(const v1::WatchJobResponse& event, double seconds) {
  notice.clear();
  if (_between_stages && (event.has_samples() || event.load_cases_ended_size() > 0)) begin_stage();
  switch (event.event_case()) {
    case v1::WatchJobResponse::kSnapshot:
      apply(event.snapshot().job());
      break;
    case v1::WatchJobResponse::kSamples:
      apply(event.samples());
      break;
    case v1::WatchJobResponse::kPhase:
      enter(event.phase().state(), event.phase().detail());
      if (sweep && state == v1::JobStatus::STATE_RUNNING)
        sweep->apply(v1::SweepRows(), seconds);  // without rows: the rate is measured from here on
      break;
    case v1::WatchJobResponse::kHeartbeat:
      enter(event.heartbeat().state(), event.heartbeat().detail());
      break;
    case v1::WatchJobResponse::kEnded:
      apply(event.ended());
      break;
    case v1::WatchJobResponse::kSweepRows:
      if (sweep) sweep->apply(event.sweep_rows(), seconds);
      break;
    case v1::WatchJobResponse::kGrowthStep: {
      const v1::GrowthRow& row = event.growth_step().row();
      enter(
          v1::JobStatus::STATE_RUNNING,
          fmt::format("front on {} at {}, load {}{}", row.interface(), number(row.position(), 4),
                      number(row.load(), 4),
                      row.has_g1_upper()
                          ? fmt::format(", to the next {} to {}", number(row.load_lower(), 4),
                                        row.has_load_upper() ? number(row.load_upper(), 4) : "any")
                          : ""));
      break;
    }
    case v1::WatchJobResponse::kStageEnded:
    case v1::WatchJobResponse::EVENT_NOT_SET:
      break;  // only ended load cases, or an event of a later version
  }
  for (const v1::LoadCaseEnded& load_case : event.load_cases_ended())
    if (load_case.load_case() >= 0)
      apply(static_cast<std::size_t>(load_case.load_case()), load_case.answer());
  if (event.has_stage_ended()) apply(event.stage_ended());
}

void JobProgress::begin_stage() {
  _between_stages = false;
  ended_count = 0;
  for (CaseProgress& each : cases) {
    CaseProgress anew;
    anew.name = std::move(each.name);
    each = std::move(anew);
  }
}

// Adds a stage, unless the snapshot had it already: a late watch repeats stages.
void JobProgress::apply(const v1::Stage& stage) {
  _between_stages = true;
  const auto known = std::ranges::find(stages, stage.mesh(), &v1::Stage::mesh);
  if (known == stages.end()) stages.push_back(stage);
}

void JobProgress::enter(v1::JobStatus::State next, const std::string& what) {
  if (client::ended(state)) return;  // a late watch repeats old phases
  state = next;
  detail = sanitise(what);
}

void JobProgress::apply(const v1::Job& job_now) {
  const v1::JobSpec& spec = job_now.spec();
  const v1::JobStatus& now = job_now.status();
  job = sanitise(job_now.name());
  if (now.attempt() > attempt && attempt > 0) {
    cases.clear();  // the server was restarted and runs the job again
    ended_count = 0;
    if (sweep) sweep->restart();
  }
  attempt = std::max(attempt, now.attempt());
  if (state != now.state()) detail.clear();
  state = now.state();
  if (now.has_end_time()) elapsed = seconds_between(now.create_time(), now.end_time());
  const v1::Uzawa& uzawa = spec.solver().uzawa();
  active_set = !spec.solver().has_uzawa();
  target = uzawa.has_kkt_tolerance() ? 0 : uzawa.epsilon();
  if (spec.has_sweep()) {
    if (!sweep) sweep.emplace();
    sweep->apply(now.sweep_answer());
    return;
  }
  if (spec.has_accuracy()) {
    accuracy = spec.accuracy();
    begin_stage();  // the answers are those of the newest stage
    stages = stages_of(job_now);
    _between_stages =
        !stages.empty() && stages.size() == static_cast<std::size_t>(now.stages_size());
  }
  cases.resize(static_cast<std::size_t>(spec.load_cases_size()));
  for (std::size_t i = 0; i < cases.size(); ++i)
    cases[i].name = sanitise(spec.load_cases(static_cast<int>(i)).name());
  for (int i = 0; i < now.answers_size(); ++i) apply(static_cast<std::size_t>(i), now.answers(i));
}

void JobProgress::apply(const v1::Samples& samples) {
  const int count = std::min({samples.load_case_size(), samples.iteration_size(),
                              samples.criterion_size(), samples.contact_count_size()});
  for (int i = 0; i < count; ++i) {
    const auto index = static_cast<std::size_t>(samples.load_case(i));
    if (samples.load_case(i) < 0 || index >= cases.size()) continue;
    CaseProgress& progress = cases[index];
    // Skip old or late samples, since a case that has ended does not run again.
    if (ended(progress.status) || samples.iteration(i) <= progress.iteration) continue;
    progress.status = v1::LoadCaseAnswer::STATUS_RUNNING;
    progress.iteration = samples.iteration(i);
    progress.criterion = samples.criterion(i);
    progress.contact_count = samples.contact_count(i);
  }
}

void JobProgress::apply(std::size_t index, const v1::LoadCaseAnswer& answer) {
  if (index >= cases.size()) return;
  CaseProgress& progress = cases[index];
  const auto status = answer.status();
  if (ended(status) && !ended(progress.status)) progress.end_rank = ++ended_count;
  progress.status = status;
  if (answer.iterations() > 0) {
    progress.iteration = answer.iterations();
    progress.criterion = answer.criterion();
  }
  progress.seconds =
      static_cast<double>(answer.solve_time().seconds()) + 1e-9 * answer.solve_time().nanos();
  progress.remark = sanitise(answer.has_error() ? answer.error().message() : answer.reason());
}

std::string_view word(Status status) noexcept {
  constexpr std::array<std::string_view, 7> words{
      "unknown", "waiting", "running", "converged", "not converged", "failed", "cancelled"};
  return word_of(words, static_cast<int>(status));
}

std::string_view word(v1::JobStatus::State state) noexcept {
  constexpr std::array<std::string_view, 8> words{
      "submitted", "queued",    "waiting for the mesh", "running", "done",
      "failed",    "cancelled", "not converged"};
  return word_of(words, state);
}

std::string_view word(v1::Mesh::State state) noexcept {
  constexpr std::array<std::string_view, 7> words{"unknown", "waiting", "meshing", "factorising",
                                                  "ready",   "evicted", "failed"};
  return word_of(words, state);
}

std::string state_text(const v1::Mesh& mesh) {
  std::string text(word(mesh.state()));
  if (!mesh.has_progress()) return text;
  const v1::MeshProgress& progress = mesh.progress();
  if (!progress.doing().empty()) text += ": " + sanitise(progress.doing());
  if (progress.triangles() > 0) text += fmt::format(", {} triangles", progress.triangles());
  if (progress.expected_triangles() > 0)
    text += fmt::format(" of about {}", progress.expected_triangles());
  return text;
}

double seconds_between(const google::protobuf::Timestamp& from,
                       const google::protobuf::Timestamp& to) {
  constexpr double milliseconds = 1000;
  return static_cast<double>(TimeUtil::DurationToMilliseconds(to - from)) / milliseconds;
}

bool ended(Status status) noexcept {
  return status >= v1::LoadCaseAnswer::STATUS_CONVERGED &&
         status <= v1::LoadCaseAnswer::STATUS_CANCELLED;
}

double bar_fraction(double criterion, double target) noexcept {
  if (std::isnan(criterion)) return 0;
  if (criterion <= target) return 1;
  if (criterion >= 1 || !(target > 0)) return 0;
  return std::log(criterion) / std::log(target);
}

}  // namespace anticrack::cli
