// SPDX-License-Identifier: GPL-3.0-or-later
//
// The steps that are common to commands that submit a case and wait for it.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "cli/follow.hpp"
#include "cli/session.hpp"
#include "cli/submit.hpp"
#include "results/result.hpp"

namespace anticrack::cli {

/// The file for the results: `output`, or CASE.h5 in this folder if that is empty. Throws
/// results::Error if it cannot be written, or is the case.
std::filesystem::path result_file(const std::string& case_file, const std::string& output);

/// Submits a case and shows its progress. If the server comes back without its jobs, the same job
/// is submitted again under the same id. `rows`: those of a sweep.
Followed submit_and_follow(Session& session, const Case& the_case, const Prepare& prepare = {},
                           std::uint64_t rows = 0);

/// The exit code for a job that was followed, without regard to its answers. Prints the job for
/// --json if the command detached from it.
int exit_code_of(const Globals& globals, const Followed& followed);

/// The results of a job that has ended, with the text of its case and the time since `begin`. Empty
/// if it has none; then the user is told why.
std::optional<results::Result> results_of(Session& session, const Case& the_case,
                                          const Followed& followed,
                                          std::chrono::steady_clock::time_point begin);

/// Writes the result file of a job that was followed; if that fails, says how to fetch the results
/// again.
void save(const std::filesystem::path& file, const results::Result& result, const Session& session);

/// Prints the answers, and where they were saved; with --quiet only what is wrong with them.
void print_answers(const Globals& globals, const v1::Job& job, const results::Result& result,
                   const std::filesystem::path& file);

}  // namespace anticrack::cli
