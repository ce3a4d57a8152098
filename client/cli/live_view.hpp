// SPDX-License-Identifier: GPL-3.0-or-later
//
// A job's progress as text: frames for a terminal, lines for a pipe. Pure functions of the
// progress.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cli/progress.hpp"

namespace anticrack::cli {

/// At most `height` lines (three, if that is more) of fewer than `width` columns each: a head line,
/// a line each for what is wrong and for what Ctrl-C has brought about, then one line per load
/// case. With more load cases than lines: those running, the last ones that ended, the next ones,
/// in their order in the job, and a last line that counts the others. Of a sweep one line: a bar,
/// rows a second, time left, rows that did not converge. What does not fit is left out in an order
/// that keeps state, progress and criterion longest.
std::vector<std::string> frame(const JobProgress& progress, std::size_t width, std::size_t height);

/// What a pipe is told: changes of state, ends of load cases, and iterations 50, 100, 200, ...,
/// each time twice as many, so that a long iteration does not fill a log; of a sweep each tenth of
/// its rows.
class PlainLog {
 public:
  /// Lines for what has changed since the last call.
  std::vector<std::string> lines(const JobProgress& progress);

  static constexpr std::int64_t first_told = 50;

 private:
  struct Seen {
    results::Status status = results::Status::pending;
    std::int64_t due = first_told;  ///< iterations that are told of next
  };
  void add_sweep_line(const SweepProgress& sweep, std::vector<std::string>& lines);

  std::string _head;
  std::string _prompt;
  std::int32_t _attempt = 0;
  std::vector<Seen> _cases;
  std::uint64_t _rows = 0;  // told of a sweep
};

}  // namespace anticrack::cli
