// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the server remembers of meshes and jobs.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "contact/answer.hpp"
#include "errors/errors.hpp"
#include "fem/load.hpp"
#include "fields/fields.hpp"
#include "mesh/geometry.hpp"

namespace anticrack::records {

using Clock = std::chrono::system_clock;

// The numbers of enums are those of the API.

/// An uploaded .msh, by the sha256 of its bytes; the file lies in the store's folder.
struct UploadRef {
  std::string sha256;
  mesh::MeshOptions options{};
};
ANTICRACK_FIELDS(UploadRef, sha256, options)

struct GeometrySource {
  mesh::Geometry geometry;
  mesh::MeshOptions options;
};
ANTICRACK_FIELDS(GeometrySource, geometry, options)

/// Another mesh, whose triangles were bisected for a job.
struct Refinement {
  std::string parent;         ///< id; the mesh may have been erased
  std::string job;            ///< id of the job
  std::string levels_sha256;  ///< hash of mesh::refine()'s levels
};
ANTICRACK_FIELDS(Refinement, parent, job, levels_sha256)

/// The source of a mesh; the mesh's identity is the hash of this.
using MeshDefinition = std::variant<GeometrySource, UploadRef, Refinement>;

enum class MeshState { pending = 1, meshing, factorizing, ready, evicted, failed };

struct SubdomainSummary {
  std::string name;
  std::uint64_t node_count = 0;
  std::uint64_t triangle_count = 0;
  double area = 0;
  double tension = 1;
  bool floating = false;     ///< interfaces alone hold a part of it
  double minimum_angle = 0;  ///< degrees
  double shortest_edge = 0;
  double longest_edge = 0;
  std::optional<mesh::TensionLaw> tension_law{};  ///< the law; `tension` is its mean
};
ANTICRACK_FIELDS(SubdomainSummary, name, node_count, triangle_count, area, tension, floating,
                 minimum_angle, shortest_edge, longest_edge, tension_law)

struct TipSummary {
  mesh::Point at{};
  std::string interface;
  double smallest_edge = 0;
};
ANTICRACK_FIELDS(TipSummary, at, interface, smallest_edge)

struct SegmentSummary {
  mesh::Kind kind = mesh::Kind::glue;
  std::int32_t inclusion = -1;
  double begin = 0;
  double end = 0;
  std::uint64_t edge_count = 0;
};
ANTICRACK_FIELDS(SegmentSummary, kind, inclusion, begin, end, edge_count)

struct InterfaceSummary {
  std::string name;
  double length = 0;
  std::uint64_t node_count = 0;
  std::vector<SegmentSummary> segments;
  std::optional<mesh::Point> start{};  ///< the point where its arc length is 0
};
ANTICRACK_FIELDS(InterfaceSummary, name, length, node_count, segments, start)

/// The progress of a mesh in the mesher.
struct MeshProgress {
  std::string doing;                     ///< "bisecting a mesh"
  std::uint64_t triangles = 0;           ///< so far; 0: not counted
  std::uint64_t expected_triangles = 0;  ///< 0: not known
  bool operator==(const MeshProgress&) const = default;
};
ANTICRACK_FIELDS(MeshProgress, doing, triangles, expected_triangles)

struct MeshRecord {
  std::string id;     ///< first 16 digits of the hash of definition and owner
  std::string owner;  ///< identity of its creator; empty on a server without authentication
  std::string title;
  MeshDefinition definition;
  MeshState state = MeshState::pending;
  std::optional<errors::Error> error;  ///< when failed
  Clock::time_point created;
  // Known once meshed:
  std::string sha256;  ///< of mesh::encode(mesh): the key of the operators
  std::uint64_t node_count = 0;
  std::uint64_t triangle_count = 0;
  std::vector<SubdomainSummary> subdomains;
  std::vector<InterfaceSummary> interfaces;
  std::vector<std::string> inclusions;
  std::vector<std::string> warnings;
  double minimum_angle = 0;
  double bisection_bound = 0;  ///< degrees; 0: not graded
  std::vector<TipSummary> tips;
  double dirichlet_length = 0;
  double neumann_length = 0;
  double mesh_seconds = 0;
  // Known once factorised:
  std::uint64_t operator_bytes = 0;
  double theta_star = 0;
  double factorize_seconds = 0;
  // Further members:
  std::optional<MeshProgress> progress{};  ///< while it is meshed; not on the disk
  bool for_job = false;                    ///< only jobs want it
};
ANTICRACK_FIELDS(MeshRecord, id, owner, title, definition, state, error, created, sha256,
                 node_count, triangle_count, subdomains, interfaces, inclusions, warnings,
                 minimum_angle, bisection_bound, tips, dirichlet_length, neumann_length,
                 mesh_seconds, operator_bytes, theta_star, factorize_seconds, progress, for_job)

enum class JobState {
  queued = 1,
  waiting_for_mesh,
  running,
  succeeded,
  failed,
  cancelled,
  not_converged,  ///< ran to its end, but some cases did not converge or failed
};

/// Whether a job in this state no longer changes, except that its result may be removed.
constexpr bool ended(JobState state) noexcept { return state >= JobState::succeeded; }

/// Which jobs go first. A job that has waited long counts as more urgent (jobs/schedule.hpp).
enum class Priority { interactive = 1, normal, bulk };

/// A load case's answer without its arrays, which are in the result block.
struct CaseRecord {
  contact::Status status = contact::Status::pending;
  std::optional<errors::Error> error;  ///< when failed
  contact::AnswerSummary answer;
  std::chrono::nanoseconds solve_time{0};
};
ANTICRACK_FIELDS(CaseRecord, status, error, answer, solve_time)

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
};
ANTICRACK_FIELDS(SweepSpec, cases, upload, rows, traces, packed, bounds)

/// The summary of a sweep; its columns are in the result block.
struct SweepRecord {
  std::uint64_t converged = 0;
  std::uint64_t not_converged = 0;
  std::uint64_t failed = 0;
  int most_steps = 0;
  double worst_kkt = 0;                    ///< largest relative residual of the rows that converged
  std::chrono::nanoseconds solve_time{0};  ///< on solver threads, added up
  std::vector<std::string> warnings{};     ///< from the loads that are combined, and from bounds
};
ANTICRACK_FIELDS(SweepRecord, converged, not_converged, failed, most_steps, worst_kkt, solve_time,
                 warnings)

/// Load cases solved stage after stage, on meshes refined until their bounds are close enough.
struct AccuracySpec {
  std::optional<double> energy{};        ///< (energy_upper - energy_lower) / |energy|
  std::optional<double> displacement{};  ///< contact::error_of each inclusion's A
  std::uint64_t max_triangles = 0;       ///< 0: the server's limit
  std::chrono::milliseconds time{0};     ///< no stage begins after this time; 0: no limit
  bool keep_stages = false;              ///< keep the meshes of all stages
  bool largest = false;  ///< displacement: over the largest |A|, not each over its own
};
ANTICRACK_FIELDS(AccuracySpec, energy, displacement, max_triangles, time, keep_stages, largest)

/// A load case at the end of a stage; members are empty if it has no bounds.
struct StageAnswer {
  double energy = 0;
  std::optional<double> energy_lower{};
  std::optional<double> energy_upper{};
  std::optional<double> error_bound_relative{};
  std::optional<double> displacement_error{};  ///< largest of all inclusions, as in AccuracySpec
};
ANTICRACK_FIELDS(StageAnswer, energy, energy_lower, energy_upper, error_bound_relative,
                 displacement_error)

struct StageRecord {
  std::string mesh;  ///< id
  std::uint64_t triangles = 0;
  double seconds = 0;                  ///< from the start of the first stage to the end of this one
  std::vector<StageAnswer> answers{};  ///< (loads); empty if the stage has not ended
};
ANTICRACK_FIELDS(StageRecord, mesh, triangles, seconds, answers)

/// Names of units, for readers; empty: none.
struct Units {
  std::string length;
  std::string force;
};
ANTICRACK_FIELDS(Units, length, force)

/// The request of a client for a job.
struct JobSpec {
  std::string title;
  std::string mesh;  ///< id of the mesh
  std::vector<fem::Load> loads;
  contact::SolverOptions solver;
  bool fields = false;
  bool indicators = false;                 ///< keep indicators of the error per triangle
  bool without_bounds = false;             ///< answers have no bounds of their errors
  std::optional<SweepSpec> sweep{};        ///< loads are its basis
  std::optional<AccuracySpec> accuracy{};  ///< solved in stages
  std::optional<Units> units{};            ///< of all numbers
  Priority priority = Priority::normal;
  std::chrono::milliseconds queue_time_limit{0};  ///< from creation to start; 0: the server's limit
  std::chrono::milliseconds run_time_limit{0};    ///< from start to end; 0: the server's limit
};
ANTICRACK_FIELDS(JobSpec, title, mesh, loads, solver, fields, indicators, without_bounds, sweep,
                 accuracy, units, priority, queue_time_limit, run_time_limit)

/// A step of a job: it entered `state`, or another phase of it.
struct Step {
  Clock::time_point time;
  JobState state = JobState::queued;
  std::string detail;  ///< e.g. "meshing"
};
ANTICRACK_FIELDS(Step, time, state, detail)

struct JobRecord {
  std::string id;
  std::string owner;       ///< as MeshRecord::owner
  std::string request_id;  ///< empty: none
  JobSpec spec;
  JobState state = JobState::queued;
  std::optional<errors::Error> error;
  Clock::time_point created;
  std::optional<Clock::time_point> started;
  std::optional<Clock::time_point> ended;
  std::optional<Clock::time_point> expired;  ///< when the result was removed, by age or budget
  std::vector<CaseRecord> cases;             ///< one per load; empty for a sweep
  SweepRecord sweep;                         ///< of a sweep
  std::vector<StageRecord> stages;           ///< stages begun so far; `cases` are those of the last
  std::string not_reached;                   ///< accuracy not reached, why, and the cure
  std::uint64_t result_bytes = 0;
  int attempt = 1;             ///< counts restarts of the server while it ran
  int crashes = 0;             ///< attempts that ended because the server's process died
  std::vector<Step> timeline;  ///< of all attempts so far, at most a few dozen
};
ANTICRACK_FIELDS(JobRecord, id, owner, request_id, spec, state, error, created, started, ended,
                 expired, cases, sweep, stages, not_reached, result_bytes, attempt, crashes,
                 timeline)

}  // namespace anticrack::records
