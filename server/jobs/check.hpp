// SPDX-License-Identifier: GPL-3.0-or-later
//
// The checks of a job before any work is done on it.
#pragma once

#include <cstdint>
#include <string>

#include "jobs/job_engine.hpp"
#include "records/records.hpp"

namespace anticrack::jobs {

/// Throws errors::Error (invalid_argument, expression_invalid, limit_exceeded) for the first fault,
/// with its path in the job: "title", "load_cases", "load_cases[i].name",
/// "load_cases[i].force.expression", "solver.uzawa.theta", "queue_timeout", "run_timeout",
/// "sweep.traces[i]", ... Does not check a sweep's matrix.
void check(const records::JobSpec& spec, const EngineOptions& options);

/// The same for faults of the loads on their mesh, from its definition alone.
void check_on_mesh(const records::JobSpec& spec, const records::MeshDefinition& definition);

/// Hash of everything in the job's request, including its title: equal for equal requests only.
std::string fingerprint(const records::JobSpec& spec);

}  // namespace anticrack::jobs
