// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/live_view.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cli/text.hpp"
#include "client/jobs.hpp"

namespace anticrack::cli {
namespace {

std::string attempt_of(const JobProgress& progress) {
  return progress.attempt > 1 ? fmt::format(", attempt {}", progress.attempt) : "";
}

std::string rows_of(const SweepProgress& sweep) {
  return fmt::format("{}{}{}", sweep.done(),
                     sweep.total > 0 ? fmt::format(" of {}", sweep.total) : std::string(),
                     sweep.total == 1 ? " row" : " rows");
}

// "  10300 rows/s  5 s left  3 not converged", without the unknown parts.
std::string pace_of(const SweepProgress& sweep) {
  std::string text;
  if (std::isfinite(sweep.rate())) {
    constexpr double whole_from = 10;
    text += "  " +
            (sweep.rate() < whole_from ? number(sweep.rate(), 2)
                                       : std::to_string(std::llround(sweep.rate()))) +
            " rows/s";
  }
  if (std::isfinite(sweep.seconds_left()) && sweep.done() < sweep.total)
    text += "  " + time_text(sweep.seconds_left()) + " left";
  if (sweep.not_converged() > 0) text += fmt::format("  {} not converged", sweep.not_converged());
  if (sweep.failed() > 0) text += fmt::format("  {} failed", sweep.failed());
  return text;
}

double fraction_of(const SweepProgress& sweep) {
  return sweep.total > 0 && sweep.done() <= sweep.total
             ? static_cast<double>(sweep.done()) / static_cast<double>(sweep.total)
             : 0;
}

std::string state_of(const JobProgress& progress) {
  if (!progress.doing.empty()) return progress.doing;
  return std::string(word(progress.state)) + attempt_of(progress) +
         (progress.detail.empty() ? "" : " (" + progress.detail + ")");
}

// The time that has passed; whole seconds while the job runs, as the text would flicker otherwise.
std::string elapsed_of(const JobProgress& progress) {
  if (!std::isfinite(progress.elapsed)) return "";
  return ", " +
         time_text(client::ended(progress.state) ? progress.elapsed : std::floor(progress.elapsed));
}

// The head line. A narrow terminal drops the name of the job first, as it was printed before.
std::string head_of(const JobProgress& progress, std::size_t width) {
  const std::string name = (progress.job.empty() ? "job" : progress.job) + ": ";
  const std::string state = state_of(progress) + elapsed_of(progress);
  std::string done;
  std::string short_done;
  if (progress.sweep) {
    done = short_done = ", " + rows_of(*progress.sweep);
  } else if (progress.cases.size() > 1) {
    done = fmt::format(", {} of {} load cases ended", progress.ended_count, progress.cases.size());
    short_done = fmt::format(", {}/{} ended", progress.ended_count, progress.cases.size());
  }
  for (const std::string& text : {name + state + done, state + done})
    if (columns_of(text) <= width) return text;
  return fit(state + short_done, width);
}

// The line of a sweep; without the bar on a narrow terminal.
std::string sweep_line(const SweepProgress& sweep, std::size_t width) {
  const std::string pace = pace_of(sweep);
  const std::size_t used = columns_of(pace);
  if (sweep.total == 0 || used + bar_room > width) return fit(pace, width);
  return bar(fraction_of(sweep), width - used) + pace;
}

std::string count_of(std::int32_t iterations, bool active_set) {
  return fmt::format("{}{}{}", iterations, active_set ? " step" : " iteration",
                     iterations == 1 ? "" : "s");
}

// The criterion; empty for the active set, which ends when nothing changes any more.
std::string criterion_of(const CaseProgress& progress, bool active_set) {
  return active_set ? "" : ", criterion " + number(progress.criterion, 2, true);
}

}  // namespace

std::vector<std::string> frame(const JobProgress& progress, std::size_t width, std::size_t height) {
  // The last column stays empty, as writing to it may wrap the line.
  const std::size_t room = std::max<std::size_t>(width, 2) - 1;
  std::vector<std::string> lines{head_of(progress, room)};
  for (const std::string& message : {progress.notice, progress.prompt})
    if (!message.empty() && lines.size() < height) lines.push_back(fit("  " + message, room));
  if (progress.sweep) {
    lines.push_back(sweep_line(*progress.sweep, room));
    return lines;
  }
  std::size_t left = std::max<std::size_t>(height, lines.size() + 2) - lines.size();
  if (progress.accuracy) {
    const std::size_t for_cases = std::min(progress.cases.size(), (left + 1) / 2);
    std::vector<std::string> stages =
        stage_lines(progress.stages, *progress.accuracy, room, left - for_cases);
    left -= stages.size();
    std::ranges::move(stages, std::back_inserter(lines));
  }
  std::ranges::move(case_lines(progress, room, left), std::back_inserter(lines));
  return lines;
}

void PlainLog::add_sweep_line(const SweepProgress& sweep, std::vector<std::string>& lines) {
  constexpr std::uint64_t first = 1000;
  // Ten lines per sweep; if its size is unknown, a line whenever the rows have doubled.
  const std::uint64_t due = sweep.total > 0 ? _rows + std::max<std::uint64_t>(sweep.total / 10, 1)
                                            : std::max(2 * _rows, first);
  const bool finished = sweep.total > 0 && sweep.done() >= sweep.total && _rows < sweep.total;
  if (sweep.done() >= due || finished) {
    lines.push_back(rows_of(sweep) + pace_of(sweep));
    _rows = sweep.done();
  }
}

std::vector<std::string> PlainLog::lines(const JobProgress& progress) {
  std::vector<std::string> lines;
  std::string head = progress.job + ": " + state_of(progress);
  if (!progress.notice.empty()) head += "; " + progress.notice;
  if (head != _head) {
    lines.push_back(head);
    _head = std::move(head);
  }
  if (progress.prompt != _prompt) {
    _prompt = progress.prompt;
    if (!_prompt.empty()) lines.push_back(_prompt);
  }
  if (progress.attempt != _attempt) {
    _cases.clear();  // the iterations start again
    _rows = 0;
    _attempt = progress.attempt;
  }
  if (progress.sweep) add_sweep_line(*progress.sweep, lines);
  for (; _stages < progress.stages.size(); ++_stages)
    lines.push_back(stage_text(_stages + 1, progress.stages[_stages], *progress.accuracy));
  _cases.resize(progress.cases.size());
  for (std::size_t i = 0; i < _cases.size(); ++i) {
    const CaseProgress& now = progress.cases[i];
    Seen& seen = _cases[i];
    // Told again in each stage, except for cases that converged: the stage has a line for those.
    const bool told = progress.accuracy && now.status == v1::LoadCaseAnswer::STATUS_CONVERGED;
    const bool newly_ended = ended(now.status) && now.status != seen.status && !told;
    if (newly_ended) {
      lines.push_back(now.name + ": " + std::string(word(now.status)) +
                      (now.iteration == 0
                           ? ""
                           : " after " + count_of(now.iteration, progress.active_set) +
                                 criterion_of(now, progress.active_set)) +
                      (now.remark.empty() ? "" : "; " + now.remark));
    } else if (!ended(now.status) && now.iteration >= seen.due) {
      while (seen.due <= now.iteration) seen.due *= 2;
      lines.push_back(fmt::format("{}{}{}{}, {} nodes in contact", now.name,
                                  progress.active_set ? ": step " : ": iteration ", now.iteration,
                                  criterion_of(now, progress.active_set), now.contact_count));
    }
    seen.status = now.status;
  }
  return lines;
}

}  // namespace anticrack::cli
