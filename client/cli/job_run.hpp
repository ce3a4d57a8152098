// SPDX-License-Identifier: GPL-3.0-or-later
//
// Follows a job or a mesh with a live view, and handles Ctrl-C meanwhile; and the steps that are
// common to commands that submit a case and wait for it.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "anticrack/v1/mesh.pb.h"
#include "anticrack/v1/solve.pb.h"
#include "cli/session.hpp"
#include "cli/submit.hpp"
#include "results/result.hpp"

namespace anticrack::cli {

/// The file for the results: `output`, or CASE.h5 in this folder if that is empty. Throws
/// results::Error if it cannot be written, or is the case.
std::filesystem::path result_file(const std::string& case_file, const std::string& output);

/// The path for `csv` of the command line; empty if that is empty. Throws if the file cannot be
/// written or is `result_file`.
std::filesystem::path csv_file(const std::string& csv, const std::filesystem::path& result_file);

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

struct Followed {
  enum class How { ended, detached, cancelled };  ///< cancelled: by this command, in time
  How how = How::ended;
  v1::Job job;        ///< as it ended, or as it was when detached
  AheadFuture ahead;  ///< set by run_job
};

/// Shows a job's progress until it ends. Ctrl-C detaches and says how to attach again; a second one
/// within two seconds cancels the job. With a private server the first Ctrl-C cancels, as the
/// server would not outlive the command. `rows`: those of a sweep, if the caller knows them, since
/// the server does not tell before it has the mesh.
Followed follow(Session& session, const v1::Job& job, std::uint64_t rows = 0);

/// The exit code. Prints the job for --json if the command detached from it.
int code_of(const Globals& globals, const Followed& followed);

/// Waits until the server is done with a mesh, and returns it: READY, EVICTED or FAILED. On a
/// terminal one line shows state and time and is wiped at the end; elsewhere each state is a line.
/// Throws client::Error, and client::Interrupted on Ctrl-C, after which the server goes on.
v1::Mesh follow_mesh(Session& session, const std::string& name);

}  // namespace anticrack::cli
