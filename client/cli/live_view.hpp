// SPDX-License-Identifier: GPL-3.0-or-later
//
// The progress of a job as text: frames for a terminal, lines for a pipe. Pure.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cli/progress.hpp"

namespace anticrack::cli {

/// At most max(`height`, 3) lines of fewer than `width` columns: a head line, lines for a notice
/// and for the effect of Ctrl-C, then one line per load case. If these do not fit, it has those
/// that run, the last ones that ended and the next ones, in the order of the job, and a line that
/// counts the others. With an accuracy there is a line per stage before them; if not all fit, only
/// the last ones. A sweep has one line: bar, rows per second, time left, rows that did not
/// converge. Narrow terminals keep state, progress and criterion longest.
std::vector<std::string> frame(const JobProgress& progress, std::size_t width, std::size_t height);

/// Lines for a pipe: changes of state, ends of load cases, iterations 50, 100, 200, ... (doubling,
/// so that a long iteration does not fill a log), every tenth of a sweep, and stages.
class PlainLog {
 public:
  /// Lines about the changes since the last call.
  std::vector<std::string> lines(const JobProgress& progress);

  static constexpr std::int64_t first_told = 50;

 private:
  struct Seen {
    v1::LoadCaseAnswer::Status status = v1::LoadCaseAnswer::STATUS_PENDING;
    std::int64_t due = first_told;  ///< next iteration to print
  };
  void add_sweep_line(const SweepProgress& sweep, std::vector<std::string>& lines);

  std::string _head;
  std::string _prompt;
  std::int32_t _attempt = 0;
  std::vector<Seen> _cases;
  std::uint64_t _rows = 0;  // number printed last
  std::size_t _stages = 0;  // number of stages printed
};

/// At most `height` lines, at least 1, of at most `width` columns; see frame.
std::vector<std::string> case_lines(const JobProgress& progress, std::size_t width,
                                    std::size_t height);

inline constexpr std::size_t bar_room = 12;  ///< fewest columns of a bar
/// A bar like "  [####----]", of which `fraction` is full, in at most `room` columns (at least
/// bar_room).
std::string bar(double fraction, std::size_t room);

/// A line for each of the last stages, at most `count`. The bar is full if everything asked for is
/// reached; a narrow terminal has none.
std::vector<std::string> stage_lines(const std::vector<v1::Stage>& stages,
                                     const v1::Accuracy& asked, std::size_t width,
                                     std::size_t count);

/// "stage 4: 12345 triangles, energy 0.213 % (asked 0.1 %), A 0.8 %", and the forecast.
std::string stage_text(std::size_t number, const v1::Stage& stage, const v1::Accuracy& asked);

}  // namespace anticrack::cli
