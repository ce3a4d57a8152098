// SPDX-License-Identifier: GPL-3.0-or-later
//
// When a job with an accuracy goes on to another stage: the policy, without threads or locks.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "records/records.hpp"

namespace anticrack::jobs {

/// Throws errors::Error (invalid_argument, at "accuracy...", "solver" or "load_cases[i]...") for a
/// job that cannot be solved in stages.
void check_accuracy(const records::JobSpec& spec);

/// Bounds are of the membrane, whatever the mesh: those of the stage before hold for the answer of
/// this one as well, where they are closer.
void tighten(records::CaseRecord& answer, const records::CaseRecord& before);

/// What is kept of an answer. Its displacement_error is half the width of the bounds of A over the
/// largest |A| of the load case, or over that of each, the largest of all inclusions; unset where
/// one has no bounds.
records::StageAnswer stage_answer(const records::CaseRecord& ended_case,
                                  bool each_inclusion = false);

/// The largest of the errors over the accuracies asked for: at most 1 where they are reached,
/// infinity without bounds. Errors above 1e6 are those of a value that is 0, and count as 1e6.
double excess(const records::StageAnswer& answer, const records::AccuracySpec& wanted);

/// After a stage: whether it was the last, and what was not reached, why, with the cure.
struct Verdict {
  bool over = false;
  std::string not_reached;
  bool fall_back = false;  ///< the answers of the stage before are better: they have bounds
};
/// `stages`: all have ended; `cases`: of the last; `seconds`: since the first began.
Verdict judge(const std::vector<records::StageRecord>& stages,
              const std::vector<const records::CaseRecord*>& cases, const records::JobSpec& spec,
              std::uint64_t max_triangles, double seconds);

/// "not reached" with the accuracy that is farthest from it, for another reason to stop. `cases`:
/// of that stage, which say what is 0 within its bounds; empty: not known.
std::string not_reached(const records::StageRecord& last,
                        std::span<const records::CaseRecord* const> cases,
                        const records::JobSpec& spec, const std::string& why);

/// Which limit on the triangles of a mesh it is, with the cure.
std::string limit_reached(const records::JobSpec& spec, std::uint64_t max_triangles);

}  // namespace anticrack::jobs
