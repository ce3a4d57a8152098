// SPDX-License-Identifier: GPL-3.0-or-later

#include <fmt/core.h>
#include <google/protobuf/util/time_util.h>

#include <array>
#include <vector>

#include "cli/progress.hpp"
#include "cli/tables.hpp"
#include "cli/text.hpp"
#include "cli/to_result.hpp"

namespace anticrack::cli {
namespace {

using google::protobuf::util::TimeUtil;

// Unusual circumstances of a job, in one line.
std::string circumstances(const v1::Job& job) {
  constexpr std::array<std::string_view, 4> priorities{"normal", "interactive", "normal", "bulk"};
  std::string text = "priority " + std::string(word_of(priorities, job.spec().priority()));
  if (!job.owner().empty()) text += ", of " + sanitise(job.owner());
  if (job.status().attempt() > 1)
    text += fmt::format(", attempt {}: the server stopped while it ran", job.status().attempt());
  const auto add_limit = [&text](const char* name, const google::protobuf::Duration& time) {
    if (TimeUtil::DurationToMilliseconds(time) > 0)
      text += std::string(", ") + name + " at most " +
              number(static_cast<double>(TimeUtil::DurationToMilliseconds(time)) / 1000) + " s";
  };
  add_limit("waits", job.spec().queue_timeout());
  add_limit("runs", job.spec().run_timeout());
  return text + "\n";
}

std::string sweep_answer(const v1::SweepAnswer& answer) {
  std::string text =
      fmt::format("sweep of {} rows: {} converged, {} did not converge, {} failed\n", answer.rows(),
                  answer.converged(), answer.not_converged(), answer.failed());
  if (answer.converged() > 0) text += worst_of(answer) + "\n";
  for (const std::string& warning : answer.warnings())
    text += "warning: " + sanitise(warning) + "\n";
  return text;
}

// The steps with the seconds since the job was created, which show how long each state took.
std::string timeline(const v1::JobStatus& status) {
  if (status.timeline().empty()) return "";
  const auto& begin = status.has_create_time() ? status.create_time() : status.timeline(0).time();
  const bool again = status.timeline(status.timeline_size() - 1).attempt() > 1;
  std::vector<std::vector<std::string>> rows{{"seconds", "state"}};
  for (const v1::JobStatus::Step& step : status.timeline()) {
    const auto since = TimeUtil::DurationToMilliseconds(step.time() - begin);
    std::string what(word(step.state()));
    what += step.detail().empty() ? "" : " (" + step.detail() + ")";
    what += again ? fmt::format(", attempt {}", step.attempt()) : "";
    rows.push_back({number(static_cast<double>(since) / 1000, 6), what});
  }
  return "\ncreated " + clock_text(begin.seconds()) + "\n" + table(rows, {1});
}

}  // namespace

std::string expired_text(const v1::Job& job) {
  return "the results of " + sanitise(job.name()) +
         " were removed by age or by the server's disk budget; run the case again, and fetch in "
         "time (see anticrack server)";
}

std::string job_text(const v1::Job& job) {
  const v1::JobSpec& spec = job.spec();
  const v1::JobStatus& status = job.status();
  std::string text = sanitise(job.name()) + " on " + sanitise(spec.mesh()) + ": " +
                     std::string(word(status.state())) + "\n";
  if (!spec.title().empty()) text += sanitise(spec.title()) + "\n";
  if (status.has_error()) text += sanitise(status.error().message()) + "\n";
  if (status.result_state() == v1::JobStatus::RESULT_STATE_EXPIRED)
    text += expired_text(job) + "\n";
  return text + circumstances(job) + "\n" +
         (job.spec().has_sweep()
              ? sweep_answer(status.sweep_answer())
              : answers_table(to_loads(job), spec.units()) + accuracy_text(job)) +
         timeline(status);
}

std::vector<std::string> shortfalls(const v1::Job& job,
                                    const std::function<std::string(const v1::Status&)>& told) {
  const v1::JobStatus& status = job.status();
  if (status.state() == v1::JobStatus::STATE_CANCELLED) return {job.name() + " was cancelled"};
  std::vector<std::string> lines;
  if (status.has_error()) lines.push_back(job.name() + " failed: " + told(status.error()));
  for (const v1::LoadCaseAnswer& answer : status.answers()) {
    if (answer.status() == v1::LoadCaseAnswer::STATUS_NOT_CONVERGED)
      lines.push_back(answer.name() + " did not converge: " + answer.reason());
    // The first error of a load is most often that of its job, too.
    const std::string& cause = answer.error().message();
    if (answer.has_error() && status.error().message().find(cause) == std::string::npos)
      lines.push_back(answer.name() + " failed: " + told(answer.error()));
  }
  if (!status.not_reached().empty()) lines.push_back("not reached: " + status.not_reached());
  const v1::SweepAnswer& sweep = status.sweep_answer();
  if (sweep.not_converged() + sweep.failed() > 0) {
    lines.push_back(fmt::format("of {} rows {} did not converge, {} failed", sweep.rows(),
                                sweep.not_converged(), sweep.failed()));
  }
  return lines;
}

}  // namespace anticrack::cli
