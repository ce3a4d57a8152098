// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is asked for with a job.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "contact/options.hpp"
#include "fem/load.hpp"
#include "fields/fields.hpp"
#include "growth/path.hpp"
#include "mesh/bend.hpp"
#include "records/priority.hpp"

namespace anticrack::records {

/// Many load cases, answered in columns: the rows of a matrix, row-major f64, that is an upload.
struct SweepSpec {
  enum class Cases {
    combinations,  ///< (rows, loads): row k is the load sum_j c_kj loads[j]
    nodal_forces,  ///< (rows, nodes of the mesh): row k is f on the nodes, linear between
  };
  Cases cases = Cases::combinations;
  std::string upload;                   ///< sha256 of the matrix's bytes
  std::uint64_t rows = 0;               ///< for nodal forces set when the job starts
  std::vector<std::uint32_t> traces{};  ///< rows whose traces are kept, ascending
  bool packed = false;                  ///< the matrix came with the job
  bool bounds = false;                  ///< rows have bounds of their errors
  bool tips = false;                    ///< rows have numbers of tips
};
ANTICRACK_FIELDS(SweepSpec, cases, upload, rows, traces, packed, bounds, tips)

/// Load cases solved stage after stage, on meshes refined until their bounds are close enough.
struct AccuracySpec {
  std::optional<double> energy{};        ///< (energy_upper - energy_lower) / |energy|
  std::optional<double> displacement{};  ///< contact::error_of each inclusion's A
  std::uint64_t max_triangles = 0;       ///< 0: the server's limit
  std::chrono::milliseconds time{0};     ///< no stage begins after this time; 0: no limit
  bool keep_stages = false;              ///< keep the meshes of all stages
  bool largest = false;  ///< displacement: over the largest |A|, not each over its own
  std::optional<double> displacement_estimated{};  ///< as displacement, by estimate
};
ANTICRACK_FIELDS(AccuracySpec, energy, displacement, max_triangles, time, keep_stages, largest,
                 displacement_estimated)

/// Growth under each load case, along paths that the mesh has as open.
struct GrowthSpec {
  std::vector<growth::Path> paths;
  std::string inclusion;             ///< its displacement is increased; empty: the load
  std::int32_t positions = 0;        ///< about so many; 0: 200
  std::int32_t final_positions = 0;  ///< how many have a mesh of their own, and bounds
  double final_error = 0;            ///< of G1 between them, half the width of its bounds; 0: 0.05
  std::string dead;                  ///< the load that acts beside the others; empty: none
  std::int32_t membranes = 0;        ///< rows whose u is kept; 0: as jumps are
};
ANTICRACK_FIELDS(GrowthSpec, paths, inclusion, positions, final_positions, final_error, dead,
                 membranes)

/// Names of units, for readers; empty: none.
struct Units {
  std::string length;
  std::string force;
};
ANTICRACK_FIELDS(Units, length, force)

/// A point, or with `to` a line of evenly spaced points, at which answers tell u.
struct Probe {
  std::string name;
  mesh::Point from{};
  std::optional<mesh::Point> to{};
  int points = 0;  ///< of a line
};
ANTICRACK_FIELDS(Probe, name, from, to, points)

/// The request of a client for a job.
struct JobSpec {
  std::string title;
  std::string mesh;  ///< id of the mesh
  std::vector<fem::Load> loads;
  contact::SolverOptions solver;
  bool fields = false;
  bool indicators = false;                 ///< keep indicators of the error per triangle
  bool balanced_flux = false;              ///< keep the flux behind the bounds
  bool without_bounds = false;             ///< answers have no bounds of their errors
  std::optional<SweepSpec> sweep{};        ///< loads are its basis
  std::optional<AccuracySpec> accuracy{};  ///< solved in stages
  std::optional<GrowthSpec> growth{};      ///< fronts grow under each load
  std::optional<Units> units{};            ///< of all numbers
  std::vector<Probe> probes{};
  Priority priority = Priority::normal;
  std::chrono::milliseconds queue_time_limit{0};  ///< from creation to start; 0: the server's limit
  std::chrono::milliseconds run_time_limit{0};    ///< from start to end; 0: the server's limit
};
ANTICRACK_FIELDS(JobSpec, title, mesh, loads, solver, fields, indicators, balanced_flux,
                 without_bounds, sweep, accuracy, growth, units, probes, priority, queue_time_limit,
                 run_time_limit)

}  // namespace anticrack::records
