// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/job_text.hpp"

#include <google/protobuf/util/time_util.h>

#include <array>
#include <vector>

#include "cli/accuracy_text.hpp"
#include "cli/answers.hpp"
#include "cli/progress.hpp"
#include "cli/text.hpp"
#include "cli/to_result.hpp"

namespace anticrack::cli {
namespace {

using google::protobuf::util::TimeUtil;

// What is not as usual, in one line.
std::string circumstances(const v1::Job& job) {
  constexpr std::array<std::string_view, 4> priorities{"normal", "interactive", "normal", "bulk"};
  std::string text = "priority " + std::string(word_of(priorities, job.priority()));
  if (!job.owner().empty()) text += ", of " + sanitise(job.owner());
  if (job.attempt() > 1)
    text += ", attempt " + std::to_string(job.attempt()) + ": the server stopped while it ran";
  const auto add_limit = [&text](const char* name, const google::protobuf::Duration& time) {
    if (TimeUtil::DurationToMilliseconds(time) > 0)
      text += std::string(", ") + name + " at most " +
              number(static_cast<double>(TimeUtil::DurationToMilliseconds(time)) / 1000) + " s";
  };
  add_limit("waits", job.queue_timeout());
  add_limit("runs", job.run_timeout());
  return text + "\n";
}

std::string sweep_answer(const v1::Job& job) {
  const v1::SweepAnswer& answer = job.sweep_answer();
  std::string text = "sweep of " + std::to_string(answer.rows()) +
                     " rows: " + std::to_string(answer.converged()) + " converged, " +
                     std::to_string(answer.not_converged()) + " did not converge, " +
                     std::to_string(answer.failed()) + " failed\n";
  if (answer.converged() > 0) {
    text += "at most " + std::to_string(answer.most_steps()) + " steps, KKT residuals at most " +
            number(answer.worst_kkt(), 2) + "\n";
  }
  for (const std::string& warning : answer.warnings())
    text += "warning: " + sanitise(warning) + "\n";
  return text;
}

// Seconds since it was created, so that one sees how long each state took.
std::string timeline(const v1::Job& job) {
  if (job.timeline().empty()) return "";
  const auto& begin = job.has_create_time() ? job.create_time() : job.timeline(0).time();
  const bool again = job.timeline(job.timeline_size() - 1).attempt() > 1;
  std::vector<std::vector<std::string>> rows{{"seconds", "state"}};
  for (const v1::Job::Step& step : job.timeline()) {
    const auto since = TimeUtil::DurationToMilliseconds(step.time() - begin);
    std::string what(word(step.state()));
    what += step.detail().empty() ? "" : " (" + sanitise(step.detail()) + ")";
    what += again ? ", attempt " + std::to_string(step.attempt()) : "";
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
  std::string text = sanitise(job.name()) + " on " + sanitise(job.mesh()) + ": " +
                     std::string(word(job.state())) + "\n";
  if (!job.title().empty()) text += sanitise(job.title()) + "\n";
  if (job.has_error()) text += sanitise(job.error().message()) + "\n";
  if (job.result_state() == v1::Job::RESULT_STATE_EXPIRED) text += expired_text(job) + "\n";
  return text + circumstances(job) + "\n" +
         (job.has_sweep() ? sweep_answer(job)
                          : answers_table(to_loads(job), job.units()) + accuracy_text(job)) +
         timeline(job);
}

std::vector<std::string> shortfalls(const v1::Job& job) {
  if (job.state() == v1::Job::STATE_CANCELLED) return {job.name() + " was cancelled"};
  std::vector<std::string> lines;
  if (job.has_error()) lines.push_back(job.name() + " failed: " + job.error().message());
  for (const v1::LoadCaseAnswer& answer : job.answers()) {
    if (answer.status() == v1::LoadCaseAnswer::STATUS_NOT_CONVERGED)
      lines.push_back(answer.name() + " did not converge: " + answer.reason());
    if (answer.has_error()) lines.push_back(answer.name() + " failed: " + answer.error().message());
  }
  if (!job.not_reached().empty()) lines.push_back("not reached: " + job.not_reached());
  const v1::SweepAnswer& sweep = job.sweep_answer();
  if (sweep.not_converged() + sweep.failed() > 0) {
    lines.push_back("of " + std::to_string(sweep.rows()) + " rows " +
                    std::to_string(sweep.not_converged()) + " did not converge, " +
                    std::to_string(sweep.failed()) + " failed");
  }
  return lines;
}

}  // namespace anticrack::cli
