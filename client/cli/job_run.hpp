// SPDX-License-Identifier: GPL-3.0-or-later
//
// The steps that are common to commands that submit a case and wait for it.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "cli/session.hpp"
#include "cli/submit.hpp"
#include "results/result.hpp"

namespace anticrack::cli {

/// The file for the results: `output`, or CASE.h5 in this folder if that is empty. Throws
/// results::Error if it cannot be written, or is the case.
std::filesystem::path result_file(const std::string& case_file, const std::string& output);

/// What a sweep does beside the steps of every run.
struct OfSweep {
  Prepare prepare{};
  std::uint64_t rows = 0;
  /// Adds to the result what the server does not tell.
  std::function<void(results::Result&)> complete{};
  /// Called when the result file is there.
  std::function<void(const results::Result&)> saved{};
};

/// Submits a case, shows its progress, saves its results and prints them; a job that is lost with
/// its server is submitted again. If the results cannot be saved, or are left, says how to fetch
/// them. Returns the exit code. `begin`: when the user began to wait.
int run_job(Session& session, const Case& the_case, const std::filesystem::path& output,
            std::chrono::steady_clock::time_point begin, const OfSweep& more = {});

}  // namespace anticrack::cli
