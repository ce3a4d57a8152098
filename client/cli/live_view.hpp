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

/// At most `height` lines of fewer than `width` columns each: a head line, then one line per load
/// case. With more load cases than lines: those running, the last ones that ended, the next ones,
/// in their order in the job, and a last line that counts the others. Of a sweep one line: a bar,
/// rows a second, time left, rows that did not converge.
std::vector<std::string> frame(const JobProgress& progress, std::size_t width, std::size_t height);

/// What a pipe is told: changes of state, ends of load cases, and iterations 50, 100, ...; of a
/// sweep each tenth of its rows.
class PlainLog {
 public:
  /// Lines for what has changed since the last call.
  std::vector<std::string> lines(const JobProgress& progress);

  static constexpr std::int32_t stride = 50;

 private:
  struct Seen {
    v1::LoadCaseAnswer::Status status = v1::LoadCaseAnswer::STATUS_PENDING;
    std::int32_t strides = 0;
  };
  void add_sweep_line(const SweepProgress& sweep, std::vector<std::string>& lines);

  std::string _head;
  std::int32_t _attempt = 0;
  std::vector<Seen> _cases;
  std::uint64_t _rows = 0;  // told of a sweep
};

}  // namespace anticrack::cli
