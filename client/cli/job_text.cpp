// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/job_text.hpp"

#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <vector>

#include "cli/progress.hpp"
#include "cli/text.hpp"

namespace anticrack::cli {
namespace {

using google::protobuf::util::TimeUtil;

std::string_view name_of(v1::Job::Priority priority) {
  switch (priority) {
    case v1::Job::PRIORITY_INTERACTIVE:
      return "interactive";
    case v1::Job::PRIORITY_BULK:
      return "bulk";
    default:
      return "normal";
  }
}

// What is not as usual, in one line.
std::string circumstances(const v1::Job& job) {
  std::string text = "priority " + std::string(name_of(job.priority()));
  if (!job.owner().empty()) {
    text += ", of " + sanitise(job.owner());
  }
  if (job.attempt() > 1) {
    text += ", attempt " + std::to_string(job.attempt()) + ": the server stopped while it ran";
  }
  const auto add_limit = [&text](const char* name, const google::protobuf::Duration& time) {
    if (TimeUtil::DurationToMilliseconds(time) > 0) {
      text += std::string(", ") + name + " at most " +
              number(static_cast<double>(TimeUtil::DurationToMilliseconds(time)) / 1000) + " s";
    }
  };
  add_limit("waits", job.queue_timeout());
  add_limit("runs", job.run_timeout());
  return text + "\n";
}

// Names of the inclusions of all answers, in order of appearance.
std::vector<std::string> inclusions_of(const v1::Job& job) {
  std::vector<std::string> names;
  for (const v1::LoadCaseAnswer& answer : job.answers()) {
    for (const v1::InclusionAnswer& inclusion : answer.inclusions()) {
      if (std::find(names.begin(), names.end(), inclusion.name()) == names.end()) {
        names.push_back(inclusion.name());
      }
    }
  }
  return names;
}

std::string displacement_of(const v1::LoadCaseAnswer& answer, const std::string& name) {
  const auto found = std::find_if(answer.inclusions().begin(), answer.inclusions().end(),
                                  [&](const auto& inclusion) { return inclusion.name() == name; });
  return found == answer.inclusions().end() ? "-" : number(found->displacement());
}

std::string answers(const v1::Job& job) {
  const std::vector<std::string> inclusions = inclusions_of(job);
  std::vector<std::vector<std::string>> rows{{"load", "status", "iterations", "criterion"}};
  for (const std::string& name : inclusions) {
    rows[0].push_back(inclusions.size() == 1 ? "A" : "A " + sanitise(name));
  }
  rows[0].emplace_back("energy");
  std::string remarks;
  for (const v1::LoadCaseAnswer& answer : job.answers()) {
    const bool answered = answer.status() == v1::LoadCaseAnswer::STATUS_CONVERGED ||
                          answer.status() == v1::LoadCaseAnswer::STATUS_NOT_CONVERGED;
    rows.push_back({sanitise(answer.name()), std::string(word(answer.status())),
                    std::to_string(answer.iterations()),
                    answered ? number(answer.criterion(), 2, true) : "-"});
    for (const std::string& name : inclusions) {
      rows.back().push_back(answered ? displacement_of(answer, name) : "-");
    }
    rows.back().push_back(answered ? number(answer.energy()) : "-");
    const std::string& remark = answer.has_error() ? answer.error().message() : answer.reason();
    if (!remark.empty()) {
      remarks += sanitise(answer.name()) + ": " + sanitise(remark) + "\n";
    }
  }
  return table(rows, {1}) + remarks;
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
  for (const std::string& warning : answer.warnings()) {
    text += "warning: " + sanitise(warning) + "\n";
  }
  return text;
}

// Seconds since it was created: what a person wants to know is what took how long.
std::string timeline(const v1::Job& job) {
  if (job.timeline().empty()) {
    return "";
  }
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
  if (!job.title().empty()) {
    text += sanitise(job.title()) + "\n";
  }
  if (job.has_error()) {
    text += sanitise(job.error().message()) + "\n";
  }
  if (job.state() == v1::Job::STATE_EXPIRED) {
    text += expired_text(job) + "\n";
  }
  return text + circumstances(job) + "\n" + (job.has_sweep() ? sweep_answer(job) : answers(job)) +
         timeline(job);
}

}  // namespace anticrack::cli
