// SPDX-License-Identifier: GPL-3.0-or-later
//
// Errors on their way out: a message for people, a document for --json, an exit code.
#pragma once

#include <functional>
#include <stdexcept>

#include "cli/session.hpp"
#include "client/error.hpp"

namespace anticrack::cli {

/// A command line that means nothing. what() gives the bad word and the cure.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What the shell is told of a call that failed: exit_usage where another case or argument would
/// help, exit_server where another server or time would.
int exit_code_of(client::Code code) noexcept;

/// Runs a command; its exit code, or that of what it threw.
int guarded(const Globals& globals, const std::function<int()>& command);

}  // namespace anticrack::cli
