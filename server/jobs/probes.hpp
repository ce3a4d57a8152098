// SPDX-License-Identifier: GPL-3.0-or-later
//
// Points and lines at which answers tell u.
#pragma once

#include <vector>

#include "contact/answer.hpp"
#include "operators/find_points.hpp"
#include "operators/mesh_operator.hpp"
#include "records/job_spec.hpp"

namespace anticrack::jobs {

/// Most points of the probes of a job. Each is a row of every answer.
constexpr std::size_t max_probe_points = 1'000;

/// Throws errors::Error (invalid_argument, limit_exceeded) at "probes[I].points", ... for what
/// needs no mesh.
void check_probes(const std::vector<records::Probe>& probes);

/// The bytes of the points of all probes in an answer.
std::uint64_t probe_bytes(const std::vector<records::Probe>& probes);

/// The points of the probes on a mesh.
struct PlacedProbes {
  std::vector<contact::ProbeAnswer> rows;  ///< without u
  std::vector<operators::PointPlace> places;
};

/// Throws errors::Error (invalid_argument at "probes[I]", of one point "probes[I].from") for a
/// point outside the membrane.
PlacedProbes place_probes(const std::vector<records::Probe>& probes,
                          const operators::MeshOperator& mesh_operator);

/// Fills the probes of an answer with fields. O(points).
void fill_probes(const PlacedProbes& probes, const operators::MeshOperator& mesh_operator,
                 contact::Answer& answer);

}  // namespace anticrack::jobs
