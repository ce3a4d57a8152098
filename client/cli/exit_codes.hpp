// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace anticrack::cli {

// Exit codes of the commands. Scripts depend on these numbers.
inline constexpr int exit_ok = 0;
inline constexpr int exit_job_failed = 1;
inline constexpr int exit_usage = 2;          ///< usage or case file wrong
inline constexpr int exit_not_converged = 3;  ///< results are saved all the same
inline constexpr int exit_server = 4;         ///< server unreachable or refusing
inline constexpr int exit_interrupted = 130;  ///< Ctrl-C: detached or cancelled
inline constexpr int exit_closed = 141;       ///< the reader of the output, like head, has enough

}  // namespace anticrack::cli
