// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reports errors: a message for users, a document for --json, an exit code.
#pragma once

#include <functional>
#include <stdexcept>

#include "cli/session.hpp"
#include "client/error.hpp"

namespace anticrack::cli {

/// A command line that cannot be understood. what() gives the bad word and the cure.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The exit code for a call that failed: exit_usage if another case or argument would help,
/// exit_server if another server or another time would.
int exit_code_of(client::Code code) noexcept;

/// Runs a command; returns its exit code, or the one for the exception that it threw.
int guarded(const Globals& globals, const std::function<int()>& command);

}  // namespace anticrack::cli
