// SPDX-License-Identifier: GPL-3.0-or-later
//
// What can be said of a job before any work is done on it.
#pragma once

#include <cstdint>
#include <string>

#include "jobs/job_engine.hpp"
#include "records/records.hpp"

namespace anticrack::jobs {

/// Throws errors::Error (invalid_argument, expression_invalid, limit_exceeded) for the first thing
/// that is wrong, with its path in the job: "title", "load_cases", "load_cases[i].name",
/// "load_cases[i].force.expression", "solver.uzawa.theta", "queue_timeout", "run_timeout",
/// "sweep.traces[i]", ... Says nothing of a sweep's matrix.
void check(const records::JobSpec& spec, const EngineOptions& options);

/// The same of what its loads mean on its mesh, before that is made.
void check_on_mesh(const records::JobSpec& spec, const records::MeshDefinition& definition);

/// Hash of all that makes a job, its title included: equal for equal requests only.
std::string fingerprint(const records::JobSpec& spec);

}  // namespace anticrack::jobs
