// SPDX-License-Identifier: GPL-3.0-or-later
//
// The progress of a job, folded from its events. Pure: times are arguments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "anticrack/v1/solve.pb.h"

namespace anticrack::cli {

/// The errors for which Accuracy asks: relative, and the largest of all load cases; NaN if a load
/// case has no bounds.
struct StageErrors {
  double energy = 0;
  double displacement = 0;
  double probable = 0;  ///< of A by estimate
};
/// The errors of a stage that has ended.
StageErrors errors_of(const v1::Stage& stage);

/// The stages of a job that have ended.
std::vector<v1::Stage> stages_of(const v1::Job& job);

/// The progress of a sweep.
class SweepProgress {
 public:
  std::uint64_t total = 0;  ///< rows; 0: not known yet

  /// The number of rows that have ended; of these, how many did not converge, and how many failed.
  std::uint64_t done() const noexcept { return _counts.done; }
  std::uint64_t not_converged() const noexcept { return _counts.not_converged; }
  std::uint64_t failed() const noexcept { return _counts.failed; }
  /// Rows per second over the last few seconds; NaN: unknown.
  double rate() const noexcept;
  double seconds_left() const noexcept;  ///< NaN: unknown

  /// Adds rows; a new watch may repeat them. `seconds`: when they arrived, on any monotonic clock.
  void apply(const v1::SweepRows& rows, double seconds);
  /// Takes the server's counts, which are used if they are larger than those of the rows seen.
  void apply(const v1::SweepAnswer& answer);
  /// To be called when the server runs the sweep again.
  void restart();

 private:
  struct Counts {
    std::uint64_t done = 0;
    std::uint64_t not_converged = 0;
    std::uint64_t failed = 0;
  };
  struct Sample {
    double seconds = 0;
    std::uint64_t done = 0;
  };
  void raise(const Counts& counts);

  std::vector<bool> _ended;  // rows seen; a bit each
  Counts _seen;              // counted from rows
  Counts _counts;            // the larger of rows' and server's
  std::deque<Sample> _samples;
  double _now = std::numeric_limits<double>::quiet_NaN();
};

struct CaseProgress {
  std::string name;
  v1::LoadCaseAnswer::Status status = v1::LoadCaseAnswer::STATUS_PENDING;
  std::int32_t iteration = 0;
  double criterion = std::numeric_limits<double>::quiet_NaN();  ///< NaN before the first iteration
  std::int32_t contact_count = 0;
  double seconds = 0;        ///< once ended
  std::string remark;        ///< why it did not converge, or failed
  std::size_t end_rank = 0;  ///< 1 for the first that ended, and so on; 0 before its end
};

struct JobProgress {
  std::string job;    ///< its name, or that of a mesh; empty: there is nothing to show
  std::string doing;  ///< the state of a mesh, in words
  v1::JobStatus::State state = v1::JobStatus::STATE_UNSPECIFIED;
  std::string detail;        ///< phase, e.g. "meshing"
  std::string notice;        ///< a message, e.g. that the connection is lost; may be empty
  std::string prompt;        ///< the effect of Ctrl-C; empty before Ctrl-C
  std::int32_t attempt = 0;  ///< the job's attempt; 0 before the first snapshot
  bool active_set = false;   ///< few steps, no criterion; else iterations of Algorithm 2
  double target = 1e-12;     ///< target of the criterion; 0: something else ends the iteration
  std::vector<CaseProgress> cases;       ///< none for a sweep; with an accuracy of the newest stage
  std::optional<SweepProgress> sweep;    ///< for a sweep
  std::optional<v1::Accuracy> accuracy;  ///< for a job in stages
  std::vector<v1::Stage> stages;         ///< stages that have ended
  std::size_t ended_count = 0;
  /// Seconds since the job was submitted; NaN: unknown. The caller sets it until the job has ended.
  double elapsed = std::numeric_limits<double>::quiet_NaN();

  /// Updates the progress by an event. `seconds`: when the event arrived, on any monotonic clock.
  void apply(const v1::WatchJobResponse& event, double seconds = 0);

 private:
  void apply(const v1::Job& job_now);
  void apply(const v1::Stage& stage);
  void begin_stage();
  void enter(v1::JobStatus::State next, const std::string& what);
  void apply(const v1::Samples& samples);
  void apply(std::size_t index, const v1::LoadCaseAnswer& answer);

  bool _between_stages = false;  // the cases are those of a stage that has ended
};

/// The word for a status: "converged", "not converged", "running", ...
std::string_view word(v1::LoadCaseAnswer::Status status) noexcept;
/// The word for a state: "queued", "waiting for the mesh", ...
std::string_view word(v1::JobStatus::State state) noexcept;
std::string_view word(v1::Mesh::State state) noexcept;
/// The same with the progress of the mesher: "meshing: bisecting a mesh, 120000 triangles".
std::string state_text(const v1::Mesh& mesh);
/// Whether a load case with this status no longer changes.
bool ended(v1::LoadCaseAnswer::Status status) noexcept;

/// Seconds between two times, for example from creation to end of a job.
double seconds_between(const google::protobuf::Timestamp& from,
                       const google::protobuf::Timestamp& to);

/// How much of the way from 1 down to `target` is done, 0 to 1, on a log scale.
double bar_fraction(double criterion, double target) noexcept;

}  // namespace anticrack::cli
