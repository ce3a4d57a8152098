// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "base/at_once.hpp"
#include "contact/solve.hpp"

namespace anticrack::contact {
namespace {

/// g_D in a node of the Dirichlet boundary, read from any subdomain that has the node.
double dirichlet_value(const ddm::Decomposition& decomposition,
                       std::span<const ddm::CondensedLoad> loads, std::int32_t node) {
  for (std::size_t s = 0; s < loads.size(); ++s) {
    const ddm::Subdomain& subdomain = decomposition.subdomains[s];
    const auto begin = subdomain.node.begin() + static_cast<std::ptrdiff_t>(subdomain.free());
    const auto found = std::find(begin, subdomain.node.end(), node);
    if (found != subdomain.node.end()) return loads[s].dirichlet[found - begin];
  }
  return 0;
}

/// u on one side; a side on the Dirichlet boundary has no trace.
double side_value(const TraceState& state, std::int32_t subdomain, std::int32_t trace,
                  double dirichlet) {
  return subdomain < 0 ? dirichlet : state.trace[at(subdomain)][trace];
}

Trace trace_of(const TraceProblem& problem, std::span<const ddm::CondensedLoad> loads,
               const TraceState& state, const mesh::Interface& interface,
               const std::vector<ddm::SidePair>& sides) {
  Trace trace;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const ddm::SidePair& side = sides[i];
    const double dirichlet =
        side.minus < 0 || side.plus < 0
            ? dirichlet_value(problem.decomposition(), loads, interface.nodes[i])
            : 0;
    trace.u_minus.push_back(side_value(state, side.minus, side.minus_trace, dirichlet));
    trace.u_plus.push_back(side_value(state, side.plus, side.plus_trace, dirichlet));
    const bool paired = side.pair >= 0;
    const bool free = !paired && side.kind == mesh::Kind::free;
    trace.jump.push_back(paired ? state.jump[side.pair]
                         : free ? trace.u_plus.back() - trace.u_minus.back()
                                : 0);
    const bool opens = paired && problem.decomposition().pairs[at(side.pair)].unilateral();
    trace.pressure.push_back(opens ? state.mu[side.pair] : 0);
    trace.flux.push_back(paired && !opens ? state.mu[side.pair] : 0);
    trace.force.push_back(paired ? state.force[side.pair] : 0);
    trace.contact.push_back(paired ? state.contact[at(side.pair)] : 0);
  }
  return trace;
}

void append_intervals(const std::string& interface, const std::vector<double>& arc_length,
                      const std::vector<std::int32_t>& contact,
                      std::vector<ContactInterval>& intervals) {
  for (std::size_t i = 0; i < contact.size(); ++i) {
    if (contact[i] == 0) continue;
    if (i > 0 && contact[i - 1] != 0)
      intervals.back().end = arc_length[i];
    else
      intervals.push_back({interface, arc_length[i], arc_length[i]});
  }
}

/// Outward fluxes of all sides: [T du/dn] = T du2/dn2 + T du1/dn1.
void fill_inclusions(const TraceProblem& problem, const mesh::Mesh& mesh,
                     std::span<const InclusionForce> inclusion_forces, const TraceState& state,
                     Answer& answer) {
  const ddm::Decomposition& decomposition = problem.decomposition();
  for (std::size_t j = 0; j < mesh.inclusions.size(); ++j) {
    const auto motion = state.motion.col(static_cast<Eigen::Index>(j));
    const RigidForce given = inclusion_forces.empty() ? RigidForce{} : inclusion_forces[j].on_nodes;
    InclusionAnswer inclusion;
    inclusion.name = mesh.inclusions[j];
    inclusion.displacement = inclusion.displacement_mesh = motion[0];
    inclusion.slope_x = inclusion.slope_x_mesh = motion[1];
    inclusion.slope_y = inclusion.slope_y_mesh = motion[2];
    inclusion.resultant = given.force;
    inclusion.moment_x = given.moment_x;
    inclusion.moment_y = given.moment_y;
    answer.inclusions.push_back(std::move(inclusion));
  }
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const std::vector<std::int32_t>& carrier = problem.carriers()[s];
    const ddm::Subdomain& subdomain = decomposition.subdomains[s];
    for (std::size_t i = 0; i < carrier.size(); ++i) {
      if (carrier[i] < 0) continue;
      const mesh::Point& centre = decomposition.skeleton.motions[at(carrier[i])].centre;
      const double* at_node = &subdomain.part.xy[2 * (subdomain.interior + i)];
      const double flux = state.flux[s][static_cast<Eigen::Index>(i)];
      InclusionAnswer& inclusion = answer.inclusions[at(carrier[i])];
      inclusion.resultant += flux;
      inclusion.moment_x += flux * (at_node[0] - centre[0]);
      inclusion.moment_y += flux * (at_node[1] - centre[1]);
    }
  }
}

void fill_contact_length(const TraceProblem& problem, const TraceState& state, Answer& answer) {
  std::vector<ContactLength::Value> values;
  for (const ContactLength::Node& node : problem.contact_length().nodes()) {
    ContactLength::Value& value = values.emplace_back();
    if (node.pair >= 0)
      value = {state.mu[node.pair], state.jump[node.pair], state.contact[at(node.pair)] != 0};
  }
  std::vector<double> of_inclusion(answer.inclusions.size(), 0);
  const Measured all = problem.contact_length().measure(values, of_inclusion);
  answer.contact_length = all.length;
  answer.contact_length_error = all.error;
  for (std::size_t j = 0; j < of_inclusion.size(); ++j)
    answer.inclusions[j].contact_length = of_inclusion[j];
}

Eigen::Map<const Eigen::VectorXd> view(std::span<const double> values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

Eigen::Map<Eigen::VectorXd> view(std::span<double> values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

/// Of an A that is known within `half`, so that it is at most `most`.
double relative_error(const InclusionAnswer& inclusion, double half, double most, double size) {
  if (!(half > 0)) return 0;
  const double scale = inclusion.displacement_scale.value_or(0);
  return scale > 0 ? std::min(half / size, most / scale) : half / size;
}

void take_probable_error(InclusionAnswer& one) {
  if (!one.displacement_estimated_error || !one.displacement_lower || !one.displacement_upper)
    return;
  const double moved = *one.displacement_estimated_error, probable = one.displacement_mesh + moved,
               outside =
                   std::max(*one.displacement_lower - probable, probable - *one.displacement_upper);
  one.displacement_error_probable = std::max(0.5 * std::abs(moved), outside);
}

}  // namespace

double work(const RigidForce& force, const Eigen::Ref<const Eigen::Vector3d>& motion) {
  return force.force * motion[0] + force.moment_x * motion[1] + force.moment_y * motion[2];
}

Eigen::VectorXd held_values(const ddm::Decomposition& decomposition,
                            std::span<const ddm::CondensedLoad> loads) {
  const std::vector<ddm::Held>& held = decomposition.skeleton.held;
  Eigen::VectorXd values(static_cast<Eigen::Index>(held.size()));
  for (std::size_t k = 0; k < held.size(); ++k) {
    const ddm::Held& one = held[k];
    values[static_cast<Eigen::Index>(k)] =
        one.node >= 0 ? loads[at(one.subdomain)].dirichlet[one.dirichlet] : one.value;
  }
  return values;
}

void describe(const TraceProblem& problem, const mesh::Mesh& mesh, const CaseLoads& loads,
              const TraceState& state, const Sample& sample, Answer& answer) {
  const ddm::Decomposition& decomposition = problem.decomposition();
  answer.energy = answer.energy_mesh = sample.energy;
  answer.kkt = sample.kkt;
  answer.kkt_relative = relative_residuals(decomposition, state.mu, state.jump,
                                           scales_of(loads.subdomains, state), answer.kkt);
  fill_inclusions(problem, mesh, loads.inclusion_forces, state, answer);
  fill_contact_length(problem, state, answer);
  for (std::size_t c = 0; c < mesh.interfaces.size(); ++c) {
    answer.traces.push_back(trace_of(problem, loads.subdomains, state, mesh.interfaces[c],
                                     decomposition.interface_sides[c]));
    append_intervals(mesh.interfaces[c].name, mesh::arc_length(mesh, mesh.interfaces[c]),
                     answer.traces.back().contact, answer.contact_intervals);
  }
  for (const Eigen::VectorXd& trace : state.trace)
    answer.side_traces.emplace_back(trace.begin(), trace.end());
}

Eigen::VectorXd unknowns_of(const ddm::Decomposition& decomposition, const Answer& answer) {
  Eigen::VectorXd w =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(decomposition.skeleton.unknowns));
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const std::vector<std::int32_t>& unknown = decomposition.subdomains[s].unknown;
    for (std::size_t i = 0; i < unknown.size(); ++i) w[unknown[i]] = answer.side_traces[s][i];
  }
  return w;
}

void recover(const TraceProblem& problem, std::span<const Recovery> cases) {
  const auto recover_in = [&](std::size_t s) {
    std::vector<ddm::SubdomainOperator::Solved> solved;
    solved.reserve(cases.size());
    for (const Recovery& one : cases)
      solved.push_back({one.loads[s], view(one.traces[s]), view(one.u[s])});
    problem.operators()[s].recover(solved);
  };
  base::at_once(problem.operators().size(), base::Threads::allowed(), [&] { return recover_in; });
}

void recover_fields(const TraceProblem& problem, std::span<const SolvedCase> cases) {
  std::vector<Recovery> to_recover;
  for (const SolvedCase& one : cases) {
    Recovery& own = to_recover.emplace_back(Recovery{one.loads, {}, {}});
    for (const std::vector<double>& trace : one.answer.side_traces) own.traces.emplace_back(trace);
    for (const ddm::Subdomain& subdomain : problem.decomposition().subdomains)
      one.answer.fields.push_back({subdomain.node, std::vector<double>(subdomain.node.size())});
    for (Field& field : one.answer.fields) own.u.emplace_back(field.u);
  }
  recover(problem, to_recover);
}

double middle_or(double mesh, const std::optional<double>& lower,
                 const std::optional<double>& upper) {
  return lower && upper ? *lower + 0.5 * (*upper - *lower) : mesh;
}

double error_of(const InclusionAnswer& inclusion, double size) {
  const double lower = *inclusion.displacement_lower, upper = *inclusion.displacement_upper;
  return relative_error(inclusion, 0.5 * (upper - lower),
                        std::max(std::abs(lower), std::abs(upper)), size);
}

double probable_error_of(const InclusionAnswer& inclusion, double size) {
  const double half = *inclusion.displacement_error_probable;
  return relative_error(inclusion, half, std::abs(inclusion.displacement) + half, size);
}

double geometry_error_of(const InclusionAnswer& inclusion, double size) {
  const double half = inclusion.displacement_geometry_error.value_or(0);
  return relative_error(inclusion, half, std::abs(inclusion.displacement) + half, size);
}

void take_middles(AnswerSummary& answer) {
  answer.energy = middle_or(answer.energy_mesh, answer.energy_lower, answer.energy_upper);
  for (InclusionAnswer& one : answer.inclusions) {
    one.displacement =
        middle_or(one.displacement_mesh, one.displacement_lower, one.displacement_upper);
    one.slope_x = middle_or(one.slope_x_mesh, one.slope_x_lower, one.slope_x_upper);
    one.slope_y = middle_or(one.slope_y_mesh, one.slope_y_lower, one.slope_y_upper);
    if (one.displacement_lower && one.displacement_upper)
      one.displacement_error_relative = error_of(one, std::abs(one.displacement));
    take_probable_error(one);
  }
}

std::string residuals_of(const Answer& answer) {
  const auto& [equilibrium, gap, sign, complementarity] = answer.kkt_relative;
  return fmt::format(
      "the relative residuals are {:g} (equilibrium), {:g} (gap), {:g} (sign), {:g} "
      "(complementarity)",
      equilibrium, gap, sign, complementarity);
}

std::vector<TraceGeometry> trace_geometry(const ddm::Decomposition& decomposition,
                                          const mesh::Mesh& mesh) {
  std::vector<TraceGeometry> result;
  for (std::size_t c = 0; c < mesh.interfaces.size(); ++c) {
    TraceGeometry geometry;
    geometry.s = mesh::arc_length(mesh, mesh.interfaces[c]);
    for (std::size_t i = 0; i < mesh.interfaces[c].nodes.size(); ++i) {
      const auto [x, y] = mesh::position(mesh, mesh.interfaces[c].nodes[i]);
      geometry.x.push_back(x);
      geometry.y.push_back(y);
      geometry.kind.push_back(decomposition.interface_sides[c][i].kind);
    }
    result.push_back(std::move(geometry));
  }
  return result;
}

}  // namespace anticrack::contact
