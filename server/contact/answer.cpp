// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "contact/answer_parts.hpp"
#include "contact/solve.hpp"

namespace anticrack::contact {
namespace {

std::size_t at(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

/// g_D in a node of the Dirichlet boundary; every subdomain that has the node has the same value.
double dirichlet_value(const ddm::Decomposition& decomposition,
                       std::span<const ddm::CondensedLoad> loads, std::int32_t node) {
  for (std::size_t s = 0; s < loads.size(); ++s) {
    const ddm::Subdomain& subdomain = decomposition.subdomains[s];
    const auto begin = subdomain.node.begin() + static_cast<std::ptrdiff_t>(subdomain.free());
    const auto found = std::find(begin, subdomain.node.end(), node);
    if (found != subdomain.node.end()) {
      return loads[s].dirichlet[found - begin];
    }
  }
  return 0;
}

bool in_contact(const ddm::NodePair& pair, double mu) {
  return pair.unilateral() && mu > 0;
}

Trace trace_of(const TraceProblem& problem, std::span<const ddm::CondensedLoad> loads,
               const Iterate& iterate, const mesh::Interface& interface,
               const std::vector<std::int32_t>& pairs) {
  Trace trace;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i] < 0) {
      const double value = dirichlet_value(problem.decomposition(), loads, interface.nodes[i]);
      trace.u_minus.push_back(value);
      trace.u_plus.push_back(value);
      trace.jump.push_back(0);
      trace.pressure.push_back(0);
      trace.contact.push_back(0);
      continue;
    }
    const ddm::NodePair& pair = problem.decomposition().pairs[at(pairs[i])];
    trace.u_minus.push_back(iterate.trace[at(pair.minus)][pair.minus_trace]);
    trace.u_plus.push_back(iterate.trace[at(pair.plus)][pair.plus_trace]);
    trace.jump.push_back(iterate.jump[pairs[i]]);
    trace.pressure.push_back(iterate.mu[pairs[i]]);
    trace.contact.push_back(in_contact(pair, iterate.mu[pairs[i]]) ? 1 : 0);
  }
  return trace;
}

void append_intervals(std::size_t interface, const std::vector<double>& arc_length,
                      const std::vector<std::int32_t>& contact,
                      std::vector<ContactInterval>& intervals) {
  for (std::size_t i = 0; i < contact.size(); ++i) {
    if (contact[i] == 0) {
      continue;
    }
    if (i > 0 && contact[i - 1] != 0) {
      intervals.back().end = arc_length[i];
    } else {
      intervals.push_back({interface, arc_length[i], arc_length[i]});
    }
  }
}

/// Both sides' outward fluxes over the nodes of each inclusion: [du/dnu] = du2/dn2 + du1/dn1.
void fill_inclusions(const TraceProblem& problem, const mesh::Mesh& mesh, const Uzawa& uzawa,
                     Answer& answer) {
  const Iterate& iterate = uzawa.iterate();
  for (std::size_t j = 0; j < mesh.inclusions.size(); ++j) {
    answer.inclusions.push_back(
        {mesh.inclusions[j], iterate.displacement[static_cast<Eigen::Index>(j)], 0, 0});
  }
  const std::vector<Eigen::VectorXd> flux = uzawa.fluxes();
  const auto& pairs = problem.decomposition().pairs;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const ddm::NodePair& pair = pairs[i];
    const auto k = static_cast<Eigen::Index>(i);
    const double contact_length = in_contact(pair, iterate.mu[k]) ? problem.lumped_mass()[k] : 0;
    answer.contact_length += contact_length;
    if (pair.inclusion >= 0) {
      InclusionAnswer& inclusion = answer.inclusions[at(pair.inclusion)];
      inclusion.contact_length += contact_length;
      inclusion.resultant +=
          flux[at(pair.minus)][pair.minus_trace] + flux[at(pair.plus)][pair.plus_trace];
    }
  }
}

}  // namespace

void describe(const TraceProblem& problem, const mesh::Mesh& mesh,
              std::span<const ddm::CondensedLoad> loads, const Uzawa& uzawa, bool fields,
              Answer& answer) {
  const ddm::Decomposition& decomposition = problem.decomposition();
  const Iterate& iterate = uzawa.iterate();
  fill_inclusions(problem, mesh, uzawa, answer);
  for (std::size_t c = 0; c < mesh.interfaces.size(); ++c) {
    answer.traces.push_back(
        trace_of(problem, loads, iterate, mesh.interfaces[c], decomposition.interface_pairs[c]));
    append_intervals(c, mesh::arc_length(mesh, mesh.interfaces[c]), answer.traces.back().contact,
                     answer.contact_intervals);
  }
  if (fields) {
    for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
      const Eigen::VectorXd u = problem.operators()[s].recover(loads[s], iterate.trace[s]);
      answer.fields.push_back({decomposition.subdomains[s].node, {u.begin(), u.end()}});
    }
  }
}

std::vector<TraceGeometry> trace_geometry(const ddm::Decomposition& decomposition,
                                          const mesh::Mesh& mesh) {
  std::vector<TraceGeometry> result;
  for (std::size_t c = 0; c < mesh.interfaces.size(); ++c) {
    TraceGeometry geometry;
    geometry.s = mesh::arc_length(mesh, mesh.interfaces[c]);
    for (std::size_t i = 0; i < mesh.interfaces[c].nodes.size(); ++i) {
      const std::size_t node = at(mesh.interfaces[c].nodes[i]);
      const std::int32_t pair = decomposition.interface_pairs[c][i];
      geometry.x.push_back(mesh.xy[2 * node]);
      geometry.y.push_back(mesh.xy[2 * node + 1]);
      geometry.kind.push_back(pair < 0 ? mesh::Kind::glue : decomposition.pairs[at(pair)].kind);
    }
    result.push_back(std::move(geometry));
  }
  return result;
}

}  // namespace anticrack::contact
