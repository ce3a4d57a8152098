// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/live_view.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "cli/text.hpp"

namespace anticrack::cli {
namespace {

constexpr std::size_t widest_name = 24;
constexpr std::size_t narrowest_name = 8;

/// The detail that a line shows about a load case, most detailed first.
enum class Detail { labels, brief, criterion, status };

/// The widths of the columns, the same for all lines of a frame.
struct Layout {
  Detail detail = Detail::status;
  std::size_t name_width = 0;
  std::size_t status_width = 0;
  std::size_t iteration_width = 5;
  bool bar = false;
};

std::string numbers(const CaseProgress& progress, bool active_set, const Layout& layout) {
  const std::string iteration =
      pad_left(std::to_string(progress.iteration), layout.iteration_width);
  const std::string criterion = number(progress.criterion, 1, true);
  if (layout.detail == Detail::criterion) return active_set ? "step " + iteration : criterion;
  const std::string text = active_set ? "step " + iteration
                           : layout.detail == Detail::labels
                               ? "iteration " + iteration + "  criterion " + criterion
                               : "it " + iteration + "  " + criterion;
  return text + (ended(progress.status)
                     ? "  " + pad_left(number(progress.seconds, 3) + " s", 11)
                     : "  contact " + pad_left(std::to_string(progress.contact_count), 3));
}

std::string case_line(const JobProgress& job, const CaseProgress& progress, const Layout& layout,
                      std::size_t width) {
  std::string line = "  " + pad_right(fit(progress.name, layout.name_width), layout.name_width) +
                     "  " + pad_right(word(progress.status), layout.status_width);
  if (progress.iteration > 0 && layout.detail != Detail::status) {
    line += "  " + numbers(progress, job.active_set, layout);
    if (layout.bar)
      line += bar(bar_fraction(progress.criterion, job.target), width - columns_of(line));
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return fit(line, width);
}

std::size_t widest_line(const JobProgress& job, const std::vector<std::size_t>& shown,
                        const Layout& layout) {
  constexpr std::size_t uncut = 1000;  // wider than any terminal
  std::size_t widest = 0;
  for (const std::size_t i : shown)
    widest = std::max(widest, columns_of(case_line(job, job.cases[i], layout, uncut)));
  return widest;
}

// The layout with room for all columns.
Layout widest_layout(const JobProgress& job, const std::vector<std::size_t>& shown) {
  Layout layout;
  for (const std::size_t i : shown) {
    const CaseProgress& progress = job.cases[i];
    layout.name_width = std::max(layout.name_width, columns_of(progress.name));
    layout.iteration_width =
        std::max(layout.iteration_width, std::to_string(progress.iteration).size());
  }
  layout.name_width = std::min(layout.name_width, widest_name);
  // Reserve room, so that columns do not move when load cases end.
  layout.status_width = word(v1::LoadCaseAnswer::STATUS_NOT_CONVERGED).size();
  return layout;
}

std::size_t widest_status(const JobProgress& job, const std::vector<std::size_t>& shown) {
  std::size_t widest = 0;
  for (const std::size_t i : shown) widest = std::max(widest, word(job.cases[i].status).size());
  return widest;
}

// The layout for a width. A narrow terminal drops first the labels, then the bar, then the ends of
// names, then all numbers but the criterion.
Layout layout_of(const JobProgress& job, const std::vector<std::size_t>& shown, std::size_t width) {
  const Layout widest = widest_layout(job, shown);
  const std::size_t whole = widest.name_width;
  struct Try {
    Detail detail;
    bool bar;
    std::size_t narrowest = 1000;  // of names; wider than all: none is cut
  };
  constexpr Try tries[]{{Detail::labels, true},
                        {Detail::brief, true},
                        {Detail::labels, false},
                        {Detail::brief, false},
                        {Detail::brief, false, narrowest_name},
                        {Detail::criterion, false, narrowest_name},
                        {Detail::status, false, 1}};
  Layout layout;
  for (const auto& [detail, with_bar, narrowest] : tries) {
    if (with_bar && !(job.target > 0)) continue;
    layout = widest;
    layout.detail = detail;
    if (narrowest < widest_name) layout.status_width = widest_status(job, shown);
    const std::size_t used = widest_line(job, shown, layout) + (with_bar ? bar_room : 0);
    const std::size_t excess = used > width ? used - width : 0;
    layout.bar = with_bar;
    if (whole < excess + std::min(whole, narrowest)) continue;
    layout.name_width = whole - excess;
    break;
  }
  return layout;
}

// Smaller ranks are shown first.
std::size_t rank(const CaseProgress& progress, std::size_t ended_count) {
  if (progress.status == v1::LoadCaseAnswer::STATUS_RUNNING) return 0;
  constexpr std::size_t ended_shown = 3;
  if (progress.end_rank > 0) {
    const std::size_t age = ended_count - progress.end_rank;
    return age < ended_shown ? 1 : 3 + age;
  }
  return 2;
}

std::vector<std::size_t> shown_cases(const JobProgress& progress, std::size_t count) {
  std::vector<std::size_t> order(progress.cases.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (order.size() > count) {
    std::ranges::stable_sort(
        order, {}, [&](std::size_t i) { return rank(progress.cases[i], progress.ended_count); });
    order.resize(count);
    std::sort(order.begin(), order.end());
  }
  return order;
}

// "  and 38 more: 20 waiting, 18 converged".
std::string others(const JobProgress& progress, const std::vector<std::size_t>& shown) {
  std::map<v1::LoadCaseAnswer::Status, std::size_t> counts;
  for (const CaseProgress& load_case : progress.cases) ++counts[load_case.status];
  for (const std::size_t i : shown) --counts[progress.cases[i].status];
  std::string text = fmt::format("  and {} more", progress.cases.size() - shown.size());
  const char* separator = ": ";
  for (const auto& [status, count] : counts) {
    if (count == 0) continue;
    text += fmt::format("{}{} {}", std::exchange(separator, ", "), count, word(status));
  }
  return text;
}

}  // namespace

std::string bar(double fraction, std::size_t room) {
  constexpr std::size_t around = 4;  // two spaces and two brackets
  constexpr std::size_t widest = 40;
  const std::size_t width = std::min(widest, room - around);
  const auto full = static_cast<std::size_t>(fraction * static_cast<double>(width));
  return "  [" + std::string(full, '#') + std::string(width - full, '-') + "]";
}

std::vector<std::string> case_lines(const JobProgress& progress, std::size_t width,
                                    std::size_t height) {
  const bool all = progress.cases.size() <= height;
  const auto shown = shown_cases(progress, all ? height : height - 1);
  const Layout layout = layout_of(progress, shown, width);
  std::vector<std::string> lines;
  lines.reserve(shown.size() + 1);
  for (const std::size_t i : shown)
    lines.push_back(case_line(progress, progress.cases[i], layout, width));
  if (!all) lines.push_back(fit(others(progress, shown), width));
  return lines;
}

}  // namespace anticrack::cli
