// SPDX-License-Identifier: GPL-3.0-or-later
//
// Answers to load cases, as plain data without linear algebra types. A new number of an answer
// changes this header, so headers that only name an answer declare it and do not include this.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "contact/residuals.hpp"
#include "contact/status.hpp"
#include "contact/traces.hpp"
#include "fields/fields.hpp"
#include "mesh/tip_kind.hpp"

namespace anticrack::contact {

/// Bounds of the exact A and B are those of estimate/. A and B are the middles of their bounds, or,
/// without bounds, those of u on the mesh; see take_middles.
struct InclusionAnswer {
  std::string name;
  double displacement = 0;    ///< A, equation (5); u in its middle (x0, y0) if it tilts
  double resultant = 0;       ///< int [T du/dnu] ds over it, equation (6): the force on it
  double contact_length = 0;  ///< of its delaminated part, as by ContactLength
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
  /// Of displacement_mesh + displacement_estimated_error, no bound; see take_middles.
  std::optional<double> displacement_error_probable = {};
  /// Estimate of how far A with curves is from A with their chords; see estimate/chord_gap.
  std::optional<double> displacement_geometry_error = {};
};
ANTICRACK_FIELDS(InclusionAnswer, name, displacement, resultant, contact_length, slope_x, slope_y,
                 moment_x, moment_y, displacement_lower, displacement_upper,
                 displacement_estimated_error, slope_x_lower, slope_x_upper, slope_y_lower,
                 slope_y_upper, displacement_mesh, slope_x_mesh, slope_y_mesh,
                 displacement_error_relative, displacement_scale, displacement_error_probable,
                 displacement_geometry_error)

struct ContactInterval {
  std::string interface;  ///< its name
  double begin = 0;       ///< arc length of its first node in contact
  double end = 0;         ///< arc length of its last node in contact
};
ANTICRACK_FIELDS(ContactInterval, interface, begin, end)

/// A tip of a crack or an inclusion. Empty: it has no such number, or `reason` says why not.
struct TipAnswer {
  double x = 0, y = 0;
  std::string interface;
  mesh::TipKind kind = mesh::TipKind::other;
  bool closed = false;              ///< the faces touch right behind it
  std::optional<double> exponent;   ///< of the distance from it in u, while it is open
  std::optional<double> intensity;  ///< factor c of the singular part, see tips/singular.hpp
  std::optional<double> k_iii;      ///< lim (2 pi r)^1/2 T du/dn ahead of a crack tip
  std::optional<double> energy_release_rate;         ///< -dPi/da when it moves ahead by a
  std::optional<double> energy_release_rate_spread;  ///< largest less least of three radii
  std::string reason;
  std::optional<double> release_factor;  ///< of a delaminated end, see tips/singular.hpp
};
ANTICRACK_FIELDS(TipAnswer, x, y, interface, kind, closed, exponent, intensity, k_iii,
                 energy_release_rate, energy_release_rate_spread, reason, release_factor)

/// The force on a side or a hole of the boundary, see operators/boundary_forces.
struct BoundaryAnswer {
  std::string name;
  bool free = false;                  ///< T du/dn is given there, not u
  double resultant = 0;               ///< int T du/dn ds, n outwards
  double moment_x = 0, moment_y = 0;  ///< int T du/dn (x - x0) ds, (y - y0)
  double x = 0, y = 0;                ///< (x0, y0), the middle of its bounding box
  std::optional<double> resultant_lower = {}, resultant_upper = {};  ///< bounds of the exact one
  std::string no_bounds = {};                                        ///< why there are none
};
ANTICRACK_FIELDS(BoundaryAnswer, name, free, resultant, moment_x, moment_y, x, y, resultant_lower,
                 resultant_upper, no_bounds)

/// u at a point of a probe; both are one but on an interface.
struct ProbeAnswer {
  std::string name;
  double s = 0, x = 0, y = 0;
  double u_minus = 0, u_plus = 0;
};
ANTICRACK_FIELDS(ProbeAnswer, name, s, x, y, u_minus, u_plus)

/// A position of fronts that grow, and the load at which one of them leaves it (growth/).
struct GrowthRow {
  std::int32_t front = -1;  ///< the one that leaves; -1: all are closed
  std::string interface;
  double position = 0;  ///< arc length along its interface
  double x = 0, y = 0;
  std::optional<double> load, displacement;  ///< empty: none leaves; without inclusion
  double g1 = 0, toughness = 0;
  double contact_length = 0;
  std::optional<double> energy;
  bool stable = false;
  std::int32_t ties = 0;  ///< how many others would leave at nearly this load
  /// Of the first row of a crack that leaves an open delaminated end: its length under the load 1.
  std::optional<double> initial_length;
  std::optional<double> g_dead;  ///< beside a dead load: G under that alone
  // Of a final position, on a mesh of its own:
  std::optional<double> g1_final;
  std::optional<double> energy_lower, energy_upper;  ///< bounds of the exact Pi under `load`
  /// Bounds of means from here to the next final position, see growth::MeanRelease.
  std::optional<double> g1_lower, g1_upper, load_lower, load_upper;
};
ANTICRACK_FIELDS(GrowthRow, front, interface, position, x, y, load, displacement, g1, toughness,
                 contact_length, energy, stable, ties, initial_length, g_dead, g1_final,
                 energy_lower, energy_upper, g1_lower, g1_upper, load_lower, load_upper)

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
  double contact_length = 0;                ///< as by ContactLength, with
  double contact_length_error = 0;          ///< an estimate of its error, no bound
  std::vector<ContactInterval> contact_intervals;
  /// Bounds of the exact Pi, of |u - u_h| in the energy norm, and of |u - u_h| / |u_h| (estimate/).
  /// Empty if they were not asked for, or for the reason that `no_bracket` gives.
  std::optional<double> energy_lower, energy_upper, error_bound, error_bound_relative;
  std::string no_bracket;
  double energy_mesh = 0;                       ///< Pi of u on the mesh
  std::optional<double> energy_geometry_error;  ///< as displacement_geometry_error, of Pi
  std::vector<TipAnswer> tips;                  ///< one per mesh::tips
  std::vector<BoundaryAnswer> boundary;
  std::vector<ProbeAnswer> probes;
  std::vector<GrowthRow> growth;          ///< of a job with growth
  std::vector<std::string> growth_notes;  ///< jumps, what snaps, why it ends
};
ANTICRACK_FIELDS(AnswerSummary, reason, iterations, criterion, theta, theta_star, energy, kkt,
                 kkt_relative, weakly_active, warnings, inclusions, contact_length,
                 contact_intervals, energy_lower, energy_upper, error_bound, error_bound_relative,
                 no_bracket, energy_mesh, contact_length_error, energy_geometry_error, tips,
                 boundary, probes, growth, growth_notes)

/// The number that users are told of a value: the middle of its bounds, or without bounds `mesh`,
/// that of u on the mesh.
double middle_or(double mesh, const std::optional<double>& lower,
                 const std::optional<double>& upper);

/// The relative error of A, which has bounds: half their width over `size`, or, if that is less,
/// the largest |A| within them over displacement_scale, the error of 0. So an A is known to a part
/// of `size`, or to be no more than that part of its scale.
double error_of(const InclusionAnswer& inclusion, double size);
/// The same by displacement_error_probable, which it has.
double probable_error_of(const InclusionAnswer& inclusion, double size);

/// The same by displacement_geometry_error; 0 if it has none.
double geometry_error_of(const InclusionAnswer& inclusion, double size);

/// Sets the energy, A and B to the middles of their bounds, where they have bounds, and the error
/// of A, which is over its own |A|. The probable error of displacement_mesh +
/// displacement_estimated_error is half of what the estimate moved it, which is more than its
/// own error, but no less than its distance from the bounds where it is not between them.
void take_middles(AnswerSummary& answer);

struct Answer : AnswerSummary {
  Status status = Status::not_converged;
  std::vector<char> closed;   ///< active set: 1 for each contact condition with d = 0
  std::vector<Trace> traces;  ///< one per Mesh::interfaces
  /// u on the trace of each subdomain of the decomposition; fields are recovered from it.
  std::vector<std::vector<double>> side_traces;
  std::vector<Field> fields;  ///< one per Mesh::subdomains, when asked for
  /// Of growth with fields: u under the load of some rows of `growth`, one row after another, each
  /// of the subdomains one after another.
  std::vector<std::int32_t> membrane_rows;
  std::vector<double> membranes;
};

}  // namespace anticrack::contact
