// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/live_view.hpp"

#include <algorithm>
#include <cmath>

#include "cli/text.hpp"

namespace anticrack::cli {
namespace {

constexpr std::size_t widest_name = 24;
constexpr std::size_t widest_bar = 40;
constexpr std::size_t narrowest_bar = 8;
constexpr std::size_t status_width = 13;  // "not converged"

std::string attempt_of(const JobProgress& progress) {
  return progress.attempt > 1 ? ", attempt " + std::to_string(progress.attempt) : "";
}

std::string rows_of(const SweepProgress& sweep) {
  return std::to_string(sweep.done()) +
         (sweep.total > 0 ? " of " + std::to_string(sweep.total) : std::string()) + " rows";
}

// "  10300 rows/s  5 s left  3 not converged"; what is not known is left out.
std::string pace_of(const SweepProgress& sweep) {
  std::string text;
  if (std::isfinite(sweep.rate())) {
    constexpr double whole_from = 10;
    text += "  " +
            (sweep.rate() < whole_from ? number(sweep.rate(), 2)
                                       : std::to_string(std::llround(sweep.rate()))) +
            " rows/s";
  }
  if (std::isfinite(sweep.seconds_left()) && sweep.done() < sweep.total) {
    text += "  " + time_text(sweep.seconds_left()) + " left";
  }
  if (sweep.not_converged() > 0) {
    text += "  " + std::to_string(sweep.not_converged()) + " not converged";
  }
  if (sweep.failed() > 0) {
    text += "  " + std::to_string(sweep.failed()) + " failed";
  }
  return text;
}

double fraction_of(const SweepProgress& sweep) {
  return sweep.total > 0 && sweep.done() <= sweep.total
             ? static_cast<double>(sweep.done()) / static_cast<double>(sweep.total)
             : 0;
}

std::string head_of(const JobProgress& progress) {
  std::string text = progress.job.empty() ? "job" : progress.job;
  text += ": ";
  text += word(progress.state);
  text += attempt_of(progress);
  if (!progress.detail.empty()) {
    text += " (" + progress.detail + ")";
  }
  if (progress.sweep) {
    text += ", " + rows_of(*progress.sweep);
  }
  if (progress.cases.size() > 1) {
    text += ", " + std::to_string(progress.ended_count) + " of " +
            std::to_string(progress.cases.size()) + " load cases ended";
  }
  if (!progress.notice.empty()) {
    text += "; " + progress.notice;
  }
  return text;
}

std::string bar(double fraction, std::size_t width) {
  const auto full = static_cast<std::size_t>(fraction * static_cast<double>(width));
  return "[" + std::string(full, '#') + std::string(width - full, '-') + "]";
}

// A narrow terminal has no room for the bar.
std::string sweep_line(const SweepProgress& sweep, std::size_t width) {
  const std::string pace = pace_of(sweep);
  constexpr std::size_t around_bar = 4;  // two spaces and two brackets
  const std::size_t used = columns_of(pace) + around_bar;
  if (sweep.total == 0 || used + narrowest_bar > width) {
    return fit(pace, width);
  }
  return "  " + bar(fraction_of(sweep), std::min(widest_bar, width - used)) + pace;
}

std::string numbers(const CaseProgress& progress, bool active_set, bool labels) {
  const std::string iteration = pad_left(std::to_string(progress.iteration), 5);
  const std::string criterion = number(progress.criterion, 1, true);
  const std::string text = active_set ? "step " + iteration
                           : labels   ? "iteration " + iteration + "  criterion " + criterion
                                      : "it " + iteration + "  " + criterion;
  return text + (ended(progress.status)
                     ? "  " + pad_left(number(progress.seconds, 3) + " s", 11)
                     : "  contact " + pad_left(std::to_string(progress.contact_count), 3));
}

// In a narrow terminal the labels go first, then the bar.
std::string case_line(const JobProgress& job, std::size_t index, std::size_t name_width,
                      std::size_t width) {
  const CaseProgress& progress = job.cases[index];
  const std::string name = "  " + pad_right(fit(progress.name, name_width), name_width) + "  ";
  if (progress.iteration == 0) {
    return fit(name + std::string(word(progress.status)), width);
  }
  constexpr std::size_t around_bar = 4;  // two spaces and two brackets
  const std::string head = name + pad_right(word(progress.status), status_width) + "  ";
  std::string line = head + numbers(progress, job.active_set, true);
  if (columns_of(line) + around_bar + narrowest_bar > width) {
    line = head + numbers(progress, job.active_set, false);
  }
  const std::size_t used = columns_of(line) + around_bar;
  if (job.target > 0 && used + narrowest_bar <= width) {
    line += "  " +
            bar(bar_fraction(progress.criterion, job.target), std::min(widest_bar, width - used));
  }
  return fit(line, width);
}

// Smaller is shown sooner.
std::size_t rank(const CaseProgress& progress, std::size_t ended_count) {
  if (progress.status == v1::LoadCaseAnswer::STATUS_RUNNING) {
    return 0;
  }
  constexpr std::size_t ended_shown = 3;
  if (progress.end_rank > 0) {
    const std::size_t age = ended_count - progress.end_rank;
    return age < ended_shown ? 1 : 3 + age;
  }
  return 2;
}

std::vector<std::size_t> shown_cases(const JobProgress& progress, std::size_t count) {
  std::vector<std::size_t> order(progress.cases.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[i] = i;
  }
  if (order.size() > count) {
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return rank(progress.cases[a], progress.ended_count) <
             rank(progress.cases[b], progress.ended_count);
    });
    order.resize(count);
    std::sort(order.begin(), order.end());
  }
  return order;
}

std::string count_of(std::int32_t iterations, bool active_set) {
  return std::to_string(iterations) + (active_set ? " step" : " iteration") +
         (iterations == 1 ? "" : "s");
}

// The active set has none: it ends when nothing changes any more.
std::string criterion_of(const CaseProgress& progress, bool active_set) {
  return active_set ? "" : ", criterion " + number(progress.criterion, 2, true);
}

}  // namespace

std::vector<std::string> frame(const JobProgress& progress, std::size_t width, std::size_t height) {
  // The last column stays empty: a terminal may wrap when it is written.
  const std::size_t room = std::max<std::size_t>(width, 2) - 1;
  std::vector<std::string> lines{fit(head_of(progress), room)};
  if (progress.sweep) {
    lines.push_back(sweep_line(*progress.sweep, room));
    return lines;
  }
  const std::size_t case_lines = std::max<std::size_t>(height, 3) - 1;
  const bool all = progress.cases.size() <= case_lines;
  const auto shown = shown_cases(progress, all ? case_lines : case_lines - 1);
  std::size_t name_width = 0;
  for (const std::size_t i : shown) {
    name_width = std::max(name_width, columns_of(progress.cases[i].name));
  }
  name_width = std::min(name_width, widest_name);
  for (const std::size_t i : shown) {
    lines.push_back(case_line(progress, i, name_width, room));
  }
  if (!all) {
    lines.push_back(
        fit("  and " + std::to_string(progress.cases.size() - shown.size()) + " more", room));
  }
  return lines;
}

void PlainLog::add_sweep_line(const SweepProgress& sweep, std::vector<std::string>& lines) {
  constexpr std::uint64_t first = 1000;
  // Ten lines of a sweep; where its end is not known, one each time there are twice as many rows.
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
  std::string head = progress.job + ": " + std::string(word(progress.state)) + attempt_of(progress);
  if (!progress.detail.empty()) {
    head += " (" + progress.detail + ")";
  }
  if (!progress.notice.empty()) {
    head += "; " + progress.notice;
  }
  if (head != _head) {
    lines.push_back(head);
    _head = std::move(head);
  }
  if (progress.attempt != _attempt) {
    _cases.clear();  // the iterations begin anew
    _rows = 0;
    _attempt = progress.attempt;
  }
  if (progress.sweep) {
    add_sweep_line(*progress.sweep, lines);
  }
  _cases.resize(progress.cases.size());
  for (std::size_t i = 0; i < _cases.size(); ++i) {
    const CaseProgress& now = progress.cases[i];
    Seen& seen = _cases[i];
    const bool newly_ended = ended(now.status) && !ended(seen.status);
    if (newly_ended) {
      lines.push_back(now.name + ": " + std::string(word(now.status)) +
                      (now.iteration == 0
                           ? ""
                           : " after " + count_of(now.iteration, progress.active_set) +
                                 criterion_of(now, progress.active_set)) +
                      (now.remark.empty() ? "" : "; " + now.remark));
    } else if (!ended(now.status) && now.iteration / stride > seen.strides) {
      lines.push_back(now.name + (progress.active_set ? ": step " : ": iteration ") +
                      std::to_string(now.iteration) + criterion_of(now, progress.active_set) +
                      ", " + std::to_string(now.contact_count) + " nodes in contact");
    }
    seen.status = now.status;
    seen.strides = std::max(seen.strides, now.iteration / stride);
  }
  return lines;
}

}  // namespace anticrack::cli
