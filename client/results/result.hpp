// SPDX-License-Identifier: GPL-3.0-or-later
//
// The whole answer to a run, for the result file and tables: the API's messages together with the
// arrays of the server's blocks.
//
// The membrane problem, its notation and equation numbers: Rudoy & Shcherbakov (2016). Index base
// 0. Lengths, displacements and forces are in the units of the case (dimensionless in the paper);
// times are in seconds. [u] = u+ - u-; the plus side lies on the left of an interface.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "anticrack/v1/mesh.pb.h"
#include "anticrack/v1/solve.pb.h"
#include "output/file.hpp"
#include "results/sweep.hpp"

namespace anticrack::results {

/// A result that cannot be written, read or assembled.
using output::Error;

struct Mesh {
  v1::Mesh info;                        ///< without the definition and the interfaces' segments
  std::vector<double> xy;               ///< (n,2) row-major
  std::vector<std::int32_t> triangles;  ///< (m,3) row-major, counterclockwise
  std::vector<std::int32_t> subdomain;  ///< (m) index into info.subdomains
  std::vector<std::int32_t> boundary;   ///< (b,2) row-major, edges where u is prescribed
};

/// A chain of k nodes; a closed one repeats its first node at the end.
struct Interface {
  std::vector<double> s;                     ///< (k) arc length from its start, increasing
  std::vector<double> x, y;                  ///< (k)
  std::vector<std::int32_t> kind;            ///< (k) InterfaceKind; a tip has its neighbour's kind
  std::vector<std::int32_t> edge_kind;       ///< (k-1)
  std::vector<std::int32_t> edge_inclusion;  ///< (k-1) index into Mesh.inclusions, -1 for none

  /// k of the shapes above.
  std::size_t node_count() const noexcept { return s.size(); }
  bool operator==(const Interface&) const = default;
};

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Values on the k nodes of one interface; every array is (k).
struct Trace {
  std::vector<double> u_minus;
  std::vector<double> u_plus;
  std::vector<double> jump;           ///< u_plus - u_minus
  std::vector<double> pressure;       ///< contact pressure, 0 on glue and bonded parts
  std::vector<double> flux;           ///< -T du/dn on these
  std::vector<double> force;          ///< nodal forces of both
  std::vector<std::int32_t> contact;  ///< 1: crack node closed under pressure
  bool operator==(const Trace&) const = default;
};

/// One entry per iteration kept by the server.
struct History {
  std::vector<std::int32_t> iteration;  ///< from 1, strictly increasing
  std::vector<double> criterion;        ///< step 3 of Algorithm 2; 1 in the first iteration
  std::vector<double> energy;           ///< Pi(u_k)
  std::vector<std::int32_t> contact_count;
  struct Residuals {
    std::vector<double> equilibrium, gap, sign, complementarity;
    bool operator==(const Residuals&) const = default;
  } kkt;  ///< absolute

  /// Iterations kept.
  std::size_t size() const noexcept { return iteration.size(); }
  bool operator==(const History&) const = default;
};

/// u on the nodes of one subdomain, with the subdomain's own trace on interfaces. A node inside a
/// slit occurs twice, once per face; `triangles` refer to the copy on their own face.
struct Field {
  std::vector<std::int32_t> nodes;      ///< (n_i) index into Mesh::xy
  std::vector<std::int32_t> triangles;  ///< (m_i,3) row-major, index into nodes
  std::vector<double> tension;          ///< (m_i,3) Txx, Txy, Tyy
  std::vector<double> u;                ///< (n_i)
  bool operator==(const Field&) const = default;
};

struct Load {
  /// The name is unique and matches [A-Za-z0-9][A-Za-z0-9_. -]{0,63}. Numbers that the method does
  /// not compute are NaN or not set.
  v1::LoadCaseAnswer answer;
  std::vector<Trace> traces;  ///< one for each of Result::interfaces, or none
  History history;
  std::vector<Field> fields;  ///< one per subdomain, or none (not asked for)
  /// (m) the part of each triangle in error_bound^2; empty if not asked for or without bounds.
  std::vector<double> indicator;
  std::vector<double> balanced_flux;        ///< (m,3) as in tables.hpp; empty as `indicator`
  std::vector<std::int32_t> membrane_rows;  ///< (k) of growth with fields
  std::vector<double> membranes;            ///< (k times the nodes of all fields) as in tables.hpp
  /// Stages of a job with an accuracy, each on a finer mesh than the stage before and with the
  /// answer to this load only.
  std::vector<v1::Stage> stages;

  const std::string& name() const noexcept { return answer.name(); }
  /// Whether the answer has numbers: the load is `converged` or `not_converged`.
  bool has_answer() const noexcept {
    return answer.status() == v1::LoadCaseAnswer::STATUS_CONVERGED ||
           answer.status() == v1::LoadCaseAnswer::STATUS_NOT_CONVERGED;
  }
};

/// The name of a LoadCaseAnswer.Status in files: "not_converged".
std::string status_name(int status);

/// The largest relative residual; NaN if one of the residuals is NaN or none is known.
double largest_kkt(const v1::LoadCaseAnswer& answer) noexcept;

/// The unit of a quantity by its dimension in F (force) and L (length): "F/L^2" gives "N/mm^2".
/// Any other text, as "s", is a unit already. Returns "-" for an empty dimension, and if the case
/// does not name the unit of the length or the force.
std::string unit_of(const v1::Units& units, std::string_view dimension);
/// The unit as unit_of, for a label: empty instead of "-".
std::string label_of(const v1::Units& units, std::string_view dimension);

/// Returns "x [mm]", or the name alone if the unit is empty.
std::string labelled(const std::string& name, const std::string& unit);

struct Result {
  std::string title;
  std::string case_text;  ///< the TOML as run, overrides applied
  std::string client_version;
  std::string server_version;
  std::string job_name;      ///< "jobs/ID"
  std::string not_reached;   ///< accuracy that was not reached, what stopped the job, the cure
  double total_seconds = 0;  ///< how long the user waited
  v1::Units units;
  v1::Solver solver;  ///< of all loads; what was not asked for has the API's default
  Mesh mesh;
  std::vector<Interface> interfaces;  ///< those of mesh.info
  std::vector<Load> loads;            ///< if a sweep: its kept rows, without history
  std::optional<Sweep> sweep;         ///< set if the job is a sweep
};

/// Solve time of all load cases, or of the sweep [s].
double solve_seconds(const Result& result);

/// The name of the method: "active-set" or "uzawa".
std::string method_of(const v1::Solver& solver);

/// Describes the first invariant of what this program looks at that does not hold (names, enums,
/// columns of a sweep): "sweep.steps has 20 entries instead of 21"; empty if all hold. Arrays of
/// the mesh and of load cases go from the server into the file as they are. O(size).
std::string first_fault(const Result& result);

/// Writes a value, the middle of its bounds, and how far they are from it: "0.1038 +- 0.0010". The
/// distance has two digits, or one at 1e-6 of the value if it is smaller than that, and is rounded
/// so that the printed interval contains the bounds. Large or small numbers are
/// "(1.038 +- 0.010)e-5". Returns "-" if a bound is not finite. Python's text.interval writes the
/// same.
std::string interval(double value, double lower, double upper);

/// What a reader should know before believing the answers: that one of the units is missing; if
/// the case gives a unit of length, that u exceeds a tenth of the sheet's smaller side, as the
/// equation holds for small slopes. Empty if there is nothing to say.
std::vector<std::string> notes_on(const Result& result);

}  // namespace anticrack::results
