// SPDX-License-Identifier: GPL-3.0-or-later
//
// Errors that end a command: a message for users, a document for --json, an exit code.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

#include "cli/session.hpp"
#include "client/error.hpp"

namespace anticrack::cli {

// Exit codes of the commands. Scripts depend on these numbers.
inline constexpr int exit_ok = 0;
inline constexpr int exit_job_failed = 1;
inline constexpr int exit_usage = 2;          ///< usage or case file wrong
inline constexpr int exit_not_converged = 3;  ///< results are saved all the same
inline constexpr int exit_server = 4;         ///< server unreachable or refusing
inline constexpr int exit_interrupted = 130;  ///< Ctrl-C: detached or cancelled
inline constexpr int exit_closed = 141;       ///< the reader of the output, like head, has enough

/// A command line that cannot be understood. what() gives the bad word and the cure.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A fault in a case, a file of rows, or a flag about them. what(): place, bad value, cure.
class CaseError : public std::runtime_error {
 public:
  explicit CaseError(const std::string& message) : std::runtime_error(message) {}
  /// `place`: a file with its line, or the flag.
  CaseError(const std::string& place, const std::string& problem)
      : std::runtime_error(place + ": " + problem) {}
};

/// The exit code for a call that failed: exit_usage if another case or argument would help,
/// exit_server if another server or another time would.
int exit_code_of(client::Code code) noexcept;

/// Runs a command; returns its exit code, or the one for the exception that it threw.
int guarded(const Globals& globals, const std::function<int()>& command);

}  // namespace anticrack::cli
