// SPDX-License-Identifier: GPL-3.0-or-later
//
// The policy of when a job with an accuracy goes on to another stage, without threads or locks.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mesh/geometry.hpp"
#include "records/job_record.hpp"

namespace anticrack::jobs {

/// Throws errors::Error (invalid_argument, at "accuracy...", "solver" or "load_cases[i]...") for a
/// job that cannot be solved in stages.
void check_accuracy(const records::JobSpec& spec);

/// Takes the bounds of the stage before where they are closer: bounds hold for the exact solution,
/// whatever the mesh.
void tighten(records::CaseRecord& answer, const records::CaseRecord& before);

/// The numbers of an answer that are kept. Its displacement_error is the largest contact::error_of
/// an inclusion's A over its own |A|, or, if `largest`, over the largest |A| of the load case;
/// unset if an inclusion has no bounds.
records::StageAnswer stage_answer(const records::CaseRecord& ended_case, bool largest = false);

/// The largest ratio of an error to the part of the accuracy that is left for it: what the estimate
/// of chords leaves, at least half. At most 1 if finer meshes do not help, infinity without bounds.
/// A relative error above 1e6 is that of a value that is 0, and counts as 1e6.
double excess(const records::StageAnswer& answer, const records::AccuracySpec& wanted);

/// The rate at which the largest excess fell in the last stage: as triangles^-rate. 1, that of
/// energies and of A without contact, unless it was clearly less; at least 1/2.
double rate_of(const std::vector<records::StageRecord>& stages,
               const records::AccuracySpec& wanted);

/// The decision after a stage: whether it was the last, and why an accuracy was not reached.
struct Verdict {
  bool over = false;
  std::string not_reached;
  bool fall_back = false;  ///< the answers of the stage before are better: they have bounds
};
/// `stages`: all, each ended; `cases`: those of the last; `seconds`: since the first began;
/// `chord_angle`: of the meshes, degrees. An accuracy is reached if error and estimate of the
/// chords together keep it.
Verdict judge(const std::vector<records::StageRecord>& stages,
              const std::vector<const records::CaseRecord*>& cases, const records::JobSpec& spec,
              std::uint64_t max_triangles, double seconds,
              double chord_angle = mesh::default_chord_angle);

/// A message with the accuracy that is farthest from being reached and with `why` the job stops.
/// `cases`: those of that stage, which tell what is 0 within its bounds; may be empty.
std::string not_reached(const records::StageRecord& last,
                        std::span<const records::CaseRecord* const> cases,
                        const records::JobSpec& spec, const std::string& why);

/// The proof that needs most triangles, if that is more than the limit, with how many, and what can
/// be proved there, by the rate of its error since the last stage with at most a quarter of the
/// triangles; empty if none does, or if the rate is not known yet. A job goes on nevertheless: what
/// it can prove at the limit is the closest to what was asked.
std::string forecast(const std::vector<records::StageRecord>& stages, const records::JobSpec& spec,
                     std::uint64_t max_triangles);

/// A message that says which limit on triangles is reached, with the cure.
std::string limit_reached(const records::JobSpec& spec, std::uint64_t max_triangles);

}  // namespace anticrack::jobs
