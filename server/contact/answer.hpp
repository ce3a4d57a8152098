// SPDX-License-Identifier: GPL-3.0-or-later
//
// Options of the solvers and answers to load cases, as plain data without linear algebra types.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "fields/fields.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::contact {

/// Numbers of this enum and of Status are those of the API.
enum class Mass {
  lumped = 1,  ///< diagonal interface mass: the fixed point is the nodal contact problem
  consistent,  ///< the paper's int1d: a slightly different discrete problem
};

/// Parameters of Algorithm 2; the defaults are those of section 8 of the paper.
struct UzawaOptions {
  std::optional<double> theta = 2.0;  ///< relaxation, > 0; empty: 0.97 theta* of the mesh
  double epsilon = 1e-12;             ///< stop when the criterion of step 3 is below this; > 0
  double p = 1e5;                     ///< bound on the multipliers; >= 0
  int max_iterations = 20000;         ///< >= 1
  Mass mass = Mass::lumped;
  /// if set, > 0: bound on the relative KKT residuals, in place of epsilon and of solution_residual
  std::optional<double> kkt_tolerance;
};
ANTICRACK_FIELDS(UzawaOptions, theta, epsilon, p, max_iterations, mass, kkt_tolerance)

/// Primal-dual active set: exact contact in a handful of steps.
struct ActiveSetOptions {
  double tolerance =
      1e-12;             ///< >= 0; relative jump or pressure below which a node is weakly active
  int max_steps = 1000;  ///< >= 1
};
ANTICRACK_FIELDS(ActiveSetOptions, tolerance, max_steps)

using SolverOptions = std::variant<ActiveSetOptions, UzawaOptions>;

/// Throws errors::Error (invalid_argument) with the field at fault below the method's name:
/// "uzawa.theta", "uzawa.epsilon", "uzawa.p", "uzawa.max_iterations", "uzawa.kkt_tolerance",
/// "active_set.tolerance", "active_set.max_steps".
void check(const SolverOptions& options, int iteration_limit);

/// Residuals of the optimality conditions at an iterate. Relative ones are over the largest force
/// (condensed load, M mu, or of held values), the largest trace |u|, the largest |mu|, and the
/// product of the last two; a residual of 0 is 0.
struct KktResiduals {
  double equilibrium = 0;  ///< max |(S t - g +- M mu)_i|, force; zero to rounding in Algorithm 2
  double gap = 0;          ///< max violation of [u] = 0 (glue, tips) and [u] >= 0 (cracks)
  double sign = 0;         ///< max(0, -mu) on cracks
  double complementarity = 0;  ///< max |mu_i [u]_i| on cracks
};
ANTICRACK_FIELDS(KktResiduals, equilibrium, gap, sign, complementarity)

/// An answer is converged only where none of its relative residuals is above this bound, whatever
/// stopped the method; kkt_tolerance takes its place where it is set. Algorithm 2's gap is for this
/// relative to max_i |u_i|_V / sqrt(T_i) where that is larger than all traces, which a closing load
/// leaves near 0. The paper's examples on the paper's mesh end below 4e-5.
constexpr double solution_residual = 1e-4;

/// One iteration as the paper and its users see it.
struct Sample {
  int iteration = 0;      ///< from 1
  double criterion = 1;   ///< max_i |u_k - u_{k-1}|_V^2 / |u_k|_V^2, step 3; 1 in the first
  double energy = 0;      ///< Pi_1 + Pi_2 at the iterate
  int contact_count = 0;  ///< crack nodes with positive pressure
  KktResiduals kkt;
};

/// Called at every iteration, on the solving thread; must be quick and must not throw.
class Observer {
 public:
  virtual ~Observer() = default;
  /// Returns false to stop the load case (it ends cancelled).
  virtual bool on_iteration(const Sample& sample) = 0;
};

/// The state of a load case. One that is solved ends converged, not_converged or cancelled.
enum class Status : std::int32_t {
  pending = 1,
  running,
  converged,
  not_converged,
  failed,
  cancelled,
};

/// Bounds of the exact A and B are those of estimate/. A and B are the middles of their bounds, or,
/// without bounds, those of u on the mesh; see take_middles.
struct InclusionAnswer {
  std::string name;
  double displacement = 0;    ///< A, equation (5); u in its middle (x0, y0) if it tilts
  double resultant = 0;       ///< int [T du/dnu] ds over it, equation (6): the force on it
  double contact_length = 0;  ///< lumped length of its delaminated nodes in contact
  /// Bx, By of u = A + Bx (x - x0) + By (y - y0) along the inclusion, (x0, y0) the middle of the
  /// bounding box of its nodes; 0 if it does not tilt.
  double slope_x = 0, slope_y = 0;
  /// Moment on the inclusion about its middle: the sum of flux times (x - x0), and times (y - y0).
  /// If it does not tilt, this is the moment that keeps it from tilting.
  double moment_x = 0, moment_y = 0;
  /// Bounds of the exact A and B, and an estimate of exact A - displacement_mesh.
  std::optional<double> displacement_lower = {}, displacement_upper = {},
                        displacement_estimated_error = {};
  std::optional<double> slope_x_lower = {}, slope_x_upper = {};
  std::optional<double> slope_y_lower = {}, slope_y_upper = {};
  double displacement_mesh = 0, slope_x_mesh = 0, slope_y_mesh = 0;  ///< of u on the mesh
  /// Half the width of the bounds of A over |A|, or the error of 0 if that is less; see error_of.
  std::optional<double> displacement_error_relative = {};
  /// The size of A to which an A of 0 compares: |z| |u| >= |A|, z the answer to a unit force on it.
  std::optional<double> displacement_scale = {};
};
ANTICRACK_FIELDS(InclusionAnswer, name, displacement, resultant, contact_length, slope_x, slope_y,
                 moment_x, moment_y, displacement_lower, displacement_upper,
                 displacement_estimated_error, slope_x_lower, slope_x_upper, slope_y_lower,
                 slope_y_upper, displacement_mesh, slope_x_mesh, slope_y_mesh,
                 displacement_error_relative, displacement_scale)

struct ContactInterval {
  std::string interface;  ///< its name
  double begin = 0;       ///< arc length of its first node in contact
  double end = 0;         ///< arc length of its last node in contact
};
ANTICRACK_FIELDS(ContactInterval, interface, begin, end)

/// Traces along one interface, one value per node of mesh::Interface::nodes, ends included.
struct Trace {
  std::vector<double> u_minus;
  std::vector<double> u_plus;
  std::vector<double> jump;      ///< u_plus - u_minus
  std::vector<double> pressure;  ///< multiplier mu: contact pressure on cracks, flux on glue
  /// 1: crack node that is closed under pressure; 0 also where nodes just touch (weakly active).
  std::vector<std::int32_t> contact;
};

/// u on the nodes of one subdomain.
struct Field {
  std::vector<std::int32_t> nodes;  ///< indices into Mesh::xy
  std::vector<double> u;
};

/// The numbers of an answer, without its status and arrays.
struct AnswerSummary {
  std::string reason;  ///< for not_converged: what happened and what to change
  int iterations = 0;
  double criterion = 1;
  double theta = 0;  ///< used
  /// 2 / lambda_max(M^1/2 (F1+F2) M^1/2), Theorem 4; 0 for the active set, which does not need it.
  double theta_star = 0;
  double energy = 0;  ///< Pi(u): the middle of its bounds, or energy_mesh without bounds
  KktResiduals kkt;
  KktResiduals kkt_relative;
  int weakly_active = 0;  ///< active set: crack nodes with neither jump nor pressure
  std::vector<std::string> warnings;
  std::vector<InclusionAnswer> inclusions;  ///< one per Mesh::inclusions
  double contact_length = 0;
  std::vector<ContactInterval> contact_intervals;
  /// Bounds of the exact Pi, of |u - u_h| in the energy norm, and of |u - u_h| / |u_h| (estimate/).
  /// Empty if they were not asked for, or for the reason that `no_bracket` gives.
  std::optional<double> energy_lower, energy_upper, error_bound, error_bound_relative;
  std::string no_bracket;
  double energy_mesh = 0;  ///< Pi of u on the mesh
};
ANTICRACK_FIELDS(AnswerSummary, reason, iterations, criterion, theta, theta_star, energy, kkt,
                 kkt_relative, weakly_active, warnings, inclusions, contact_length,
                 contact_intervals, energy_lower, energy_upper, error_bound, error_bound_relative,
                 no_bracket, energy_mesh)

/// The number that users are told of a value: the middle of its bounds, or without bounds `mesh`,
/// that of u on the mesh.
double middle_or(double mesh, const std::optional<double>& lower,
                 const std::optional<double>& upper);

/// The relative error of A, which has bounds: half their width over `size`, or, if that is less,
/// the largest |A| within them over displacement_scale, the error of 0. So an A is known to a part
/// of `size`, or to be no more than that part of its scale.
double error_of(const InclusionAnswer& inclusion, double size);

/// Sets the energy, A and B to the middles of their bounds, where they have bounds, and the error
/// of A, which is over its own |A|.
void take_middles(AnswerSummary& answer);

struct Answer : AnswerSummary {
  Status status = Status::not_converged;
  std::vector<char> closed;   ///< active set: 1 for each contact condition with d = 0
  std::vector<Trace> traces;  ///< one per Mesh::interfaces
  /// u on the trace of each subdomain of the decomposition; fields are recovered from it.
  std::vector<std::vector<double>> side_traces;
  std::vector<Field> fields;  ///< one per Mesh::subdomains, when asked for
};

/// Positions of an interface's nodes, over which its traces are drawn.
struct TraceGeometry {
  std::vector<double> s, x, y;   ///< arc length from the interface's first node, coordinates
  std::vector<mesh::Kind> kind;  ///< condition in the node; a tip is `inclusion` or `glue` (tied)
};

// Answers to many load cases as columns.

/// Whether an inclusion of the mesh tilts.
inline bool tilts(const mesh::Mesh& mesh) noexcept {
  return std::ranges::any_of(mesh.motions, &mesh::Motion::tilt);
}

/// Entry k of every column belongs to row k.
struct SweepColumns {
  SweepColumns(std::size_t row_count, std::size_t inclusion_count, std::size_t contact_count,
               bool tilting = false, bool bounded = false)
      : inclusions(inclusion_count),
        contacts(contact_count),
        status(row_count, Status::not_converged),
        steps(row_count, 0),
        energy(row_count, 0),
        energy_lower(bounded ? row_count : 0, std::numeric_limits<double>::quiet_NaN()),
        energy_upper(energy_lower),
        energy_mesh(energy_lower.size(), 0),
        contact_length(row_count, 0),
        kkt(row_count, 0),
        displacement(row_count * inclusion_count, 0),
        displacement_lower(energy_lower.size() * inclusion_count,
                           std::numeric_limits<double>::quiet_NaN()),
        displacement_upper(displacement_lower),
        displacement_mesh(displacement_lower.size(), 0),
        slope(tilting ? row_count * inclusion_count * 2 : 0, 0),
        contact(row_count * contact_count, 0) {}

  std::size_t rows() const noexcept { return status.size(); }
  /// Takes the energy and A of a row with their bounds from the answer; the columns must have been
  /// made with `bounded`.
  void take_bounds(std::size_t row, const AnswerSummary& answer);

  std::size_t inclusions = 0;
  std::size_t contacts = 0;
  std::vector<Status> status;       ///< only converged rows hold results
  std::vector<std::int32_t> steps;  ///< of the active set
  std::vector<double> energy;       ///< Pi(u), as in AnswerSummary
  /// Bounds of the exact Pi, NaN where a row has none; empty if bounds were not asked for.
  std::vector<double> energy_lower, energy_upper;
  std::vector<double> energy_mesh;     ///< Pi of u on the mesh; empty if bounds were not asked for
  std::vector<double> contact_length;  ///< over all cracks and delaminated parts
  std::vector<double> kkt;             ///< largest of the relative KktResiduals
  std::vector<double> displacement;    ///< (rows, inclusions), row-major: A of equation (5)
  std::vector<double> displacement_lower, displacement_upper;  ///< bounds of A, as for the energy
  std::vector<double> displacement_mesh;                       ///< A on the mesh, as for the energy
  /// (rows, inclusions, 2), row-major: Bx, By of each on the mesh; empty where none tilts.
  std::vector<double> slope;
  std::vector<std::uint8_t> contact;  ///< (rows, contacts), row-major: 1 closed under pressure
};
ANTICRACK_FIELDS(SweepColumns, inclusions, contacts, status, steps, energy, energy_lower,
                 energy_upper, energy_mesh, contact_length, kkt, displacement, displacement_lower,
                 displacement_upper, displacement_mesh, slope, contact)

}  // namespace anticrack::contact
