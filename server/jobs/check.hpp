// SPDX-License-Identifier: GPL-3.0-or-later
//
// The checks of a job before any work is done on it.
#pragma once

#include "jobs/job_engine.hpp"
#include "records/job_spec.hpp"
#include "records/mesh_record.hpp"

namespace anticrack::jobs {

/// Throws errors::Error (invalid_argument, expression_invalid, limit_exceeded) for the first thing
/// that is wrong, with its path in the spec: "load_cases", "load_cases[i].name",
/// "load_cases[i].force.expression", "solver.uzawa.theta", "sweep.traces[i]", ... Says nothing of
/// title and times, which api::to_spec checks, nor of a sweep's matrix.
void check(const records::JobSpec& spec, const EngineOptions& options);

/// The same for faults of the loads on their mesh, from its definition alone.
void check_on_mesh(const records::JobSpec& spec, const records::MeshDefinition& definition);

}  // namespace anticrack::jobs
