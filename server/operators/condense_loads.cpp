// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/condense_loads.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/at.hpp"
#include "base/at_once.hpp"
#include "fem/adaptive_load.hpp"
#include "fem/load_vector.hpp"
#include "fem/traction.hpp"
#include "operators/check_loads.hpp"
#include "stop/stop.hpp"

namespace anticrack::operators {
namespace {

constexpr const char* integrating = "integrating a load";

void require_known_regions(const fem::Load& load, const mesh::Mesh& mesh) {
  if (const auto* regions = std::get_if<fem::PerRegion>(&load.force))
    for (const auto& [name, value] : regions->values)
      index_of(mesh.subdomains, name, "subdomain", "force.per_region[" + name + "]");
}

void require_array_fits(const fem::Load& load, const mesh::Mesh& mesh) {
  const auto* array = std::get_if<fem::Array>(&load.force);
  if (array == nullptr) return;
  const std::size_t wanted = array->per_triangle ? mesh.triangle_count() : mesh.node_count();
  const char* what = array->per_triangle ? " triangles" : " nodes";
  const std::size_t given = array->values ? array->values->size() : 0;
  if (given != wanted) {
    throw errors::Error(errors::Reason::invalid_argument,
                        "the array of the force has {} values, but the mesh has {}{}: give one "
                        "value for each, in the order of ReadMesh",
                        given, wanted, what)
        .at("force.array");
  }
}

/// The accuracy with which an expression was integrated.
struct Integrated {
  std::string what, subdomain;
  double estimate, tolerance;  ///< relative, from samples
  const fem::Proof& proof;
  double enough;  ///< the Proof::relative that suffices
};

std::string place(const fem::Proof& proof) { return errors::shown(proof.worst_x, proof.worst_y); }

/// A warning for the user if the integral is not accurate enough; else empty.
std::string inexact(const Integrated& one) {
  const std::string who = one.what + " on subdomain \"" + one.subdomain + "\"";
  if (std::isfinite(one.proof.relative())) {
    if (one.proof.relative() <= one.enough) return "";
    return fmt::format(
        "{} varies too fast near {} to be integrated in a bounded time: up to {:.2g} of its "
        "integral is unknown, which the bounds take into account; refine the mesh there or smooth "
        "the expression",
        who, place(one.proof), one.proof.relative());
  }
  if (!std::isfinite(one.estimate)) {
    return who +
           " cannot be integrated: the integral may not exist, as the expression has no bound "
           "near " +
           place(one.proof) + "; change the expression there";
  }
  if (one.estimate <= one.tolerance) return "";
  return fmt::format(
      "{} may be wrong by {:.2g} of its integral (tolerance: {:.2g}), which is an estimate: the "
      "expression has no bound near {}; refine the mesh there or change the expression",
      who, one.estimate, one.tolerance, place(one.proof));
}

/// The reason why bounds cannot be proved with this integral; empty if they can.
std::string no_proof(const Integrated& one) {
  if (std::isfinite(one.proof.unknown)) return "";
  return one.what + " on subdomain \"" + one.subdomain + "\" has no bound near " +
         place(one.proof) +
         ", so that no bounds can be proved; let the expression stay finite there";
}

/// A block of loads that are condensed together.
class Block {
 public:
  Block(std::span<const fem::Load* const> loads, const mesh::Mesh& mesh,
        const ddm::Decomposition& decomposition, const ddm::NeumannBoundary& neumann, bool parts)
      : _loads(loads),
        _decomposition(decomposition),
        _neumann(neumann),
        _parts(parts),
        _placed(loads.size()),
        _told(decomposition.subdomains.size(), std::vector<Told>(loads.size())),
        _outcomes(loads.size()) {
    for (std::size_t i = 0; i < loads.size(); ++i) {
      attempt(i, [&](LoadOnTraces& result) {
        require_known_regions(*loads[i], mesh);
        require_array_fits(*loads[i], mesh);
        require_traction_acts(*loads[i]);
        require_boundary_value_acts(*loads[i]);
        _placed[i] = place_forces(*loads[i], mesh, decomposition);
        result.warnings = std::move(_placed[i].warnings);
        result.subdomains.resize(decomposition.subdomains.size());
        result.inclusion_forces = _placed[i].inclusions;
        if (_parts) describe(*loads[i], _placed[i], result.parts);
      });
    }
  }

  /// Condenses on all subdomains, on base::Threads.
  void condense(const Condense& condense) {
    std::optional<errors::Error> failure;
    try {
      base::at_once(_told.size(), base::Threads::allowed(),
                    [&] { return [&](std::size_t s) { condense_on(s, condense); }; });
    } catch (const errors::Error& error) {  // without memory every load of the block fails
      failure = error;
    }
    for (std::size_t i = 0; i < _loads.size(); ++i) {
      for (const std::vector<Told>& of_subdomain : _told) hear(of_subdomain[i], _outcomes[i]);
      if (failure && std::holds_alternative<LoadOnTraces>(_outcomes[i])) _outcomes[i] = *failure;
    }
  }

  /// Throws if a body is held in several places at values that no motion of it can have.
  void require_agreement(const mesh::Mesh& mesh) {
    const ddm::Skeleton& skeleton = _decomposition.skeleton;
    if (skeleton.agreements.empty()) return;
    for (std::size_t i = 0; i < _loads.size(); ++i) {
      attempt(i, [&](LoadOnTraces& result) {
        const Eigen::VectorXd held = contact::held_values(_decomposition, result.subdomains);
        for (const ddm::Terms& agreement : skeleton.agreements) require_zero(agreement, held, mesh);
      });
    }
  }

  std::vector<CondensedOutcome> take() { return std::move(_outcomes); }

 private:
  /// What integrating a load on a subdomain has to say.
  struct Told {
    std::vector<std::string> warnings;
    std::string obstacle;
    std::optional<errors::Error> error;
  };

  static void hear(const Told& told, CondensedOutcome& outcome) {
    auto* result = std::get_if<LoadOnTraces>(&outcome);
    if (result == nullptr) return;
    result->warnings.insert(result->warnings.end(), told.warnings.begin(), told.warnings.end());
    if (!told.obstacle.empty()) result->parts.obstacle = told.obstacle;
    if (told.error) outcome = *told.error;
  }

  /// On one subdomain; for several threads, each with its own.
  void condense_on(std::size_t s, const Condense& condense) {
    const ddm::Subdomain& subdomain = _decomposition.subdomains[s];
    const auto columns = static_cast<Eigen::Index>(_loads.size());
    Eigen::MatrixXd dirichlet(static_cast<Eigen::Index>(subdomain.dirichlet), columns);
    std::vector<LoadOnTraces*> sound;
    Eigen::MatrixXd of_nodes = integrate_arrays(subdomain), apart;
    if (of_nodes.cols() < columns) {  // not all are arrays: put these into their columns
      apart.swap(of_nodes);
      of_nodes.resize(static_cast<Eigen::Index>(subdomain.node.size()), columns);
    }
    const Eigen::MatrixXd& of_arrays = apart.size() > 0 ? apart : of_nodes;
    Eigen::Index arrays = 0;
    for (std::size_t i = 0; i < _loads.size(); ++i) {
      auto* const result = std::get_if<LoadOnTraces>(&_outcomes[i]);
      if (result == nullptr) continue;
      const auto column = static_cast<Eigen::Index>(sound.size());
      const bool array = nodal_values(i) != nullptr;
      if (array && (&of_arrays != &of_nodes || arrays != column))
        of_nodes.col(column) = of_arrays.col(arrays);
      arrays += array ? 1 : 0;
      try {
        stop::look(integrating);
        if (!array) of_nodes.col(column) = integrate(i, s, *result);
        add_rest(i, s, *result, of_nodes.col(column));
        dirichlet.col(column) = fem::boundary_values(subdomain.part, _loads[i]->boundary_value,
                                                     subdomain.free(), subdomain.dirichlet);
        sound.push_back(result);
      } catch (const errors::Error& error) {
        _told[s][i].error = error;
      }
    }
    const auto width = static_cast<Eigen::Index>(sound.size());
    std::vector<ddm::CondensedLoad> condensed =
        condense(s, of_nodes.leftCols(width), dirichlet.leftCols(width));
    for (std::size_t k = 0; k < sound.size(); ++k)
      sound[k]->subdomains[s] = std::move(condensed[k]);
  }

  void describe(const fem::Load& load, const PlacedForces& placed, LoadParts& parts) const {
    parts.force = load.force;
    parts.integrated.resize(_decomposition.subdomains.size());
    if (!load.traction.empty()) parts.traction.resize(_decomposition.subdomains.size());
    if (!fem::is_linear(load.boundary_value)) parts.boundary_value = load.boundary_value;
    parts.beside_chords = load.boundary_value;
    parts.points = placed.points;
    if (!placed.points.empty()) {
      parts.obstacle =
          "a point force in the membrane has an infinite energy, and no bound exists; spread it "
          "over a small disc, or let it act on an inclusion";
    }
  }

  void require_zero(const ddm::Terms& agreement, const Eigen::VectorXd& held,
                    const mesh::Mesh& mesh) const {
    constexpr double rounding = 1e-9;
    double sum = 0, size = 0;
    std::string values;
    for (const auto& [k, factor] : agreement) {
      sum += factor * held[k];
      size = std::max(size, std::abs(factor * held[k]));
      const ddm::Held& one = _decomposition.skeleton.held[at(k)];
      values += (values.empty() ? "" : ", ") + errors::shown(held[k]);
      if (one.node >= 0)
        values += " at " + errors::shown(mesh.xy[2 * at(one.node)], mesh.xy[2 * at(one.node) + 1]);
    }
    if (std::abs(sum) <= rounding * size) return;
    const auto inclusion = at(_decomposition.skeleton.held[at(agreement.front().index)].inclusion);
    throw errors::Error(
        errors::Reason::invalid_argument,
        "nothing solves this load: the inclusion \"{}\" is rigid and cannot have the values {} it "
        "is held at; give values that agree, or let it tilt or end inside the membrane",
        mesh.inclusions[inclusion], values)
        .at("boundary_value");
  }

  /// Does the work for load i; an error that it throws becomes the load's outcome.
  template <class Work>
  void attempt(std::size_t i, const Work& work) {
    if (auto* result = std::get_if<LoadOnTraces>(&_outcomes[i])) {
      try {
        stop::look(integrating);
        work(*result);
      } catch (const errors::Error& error) {
        _outcomes[i] = error;
      }
    }
  }

  /// The values of load i, if it has no error and its force is given at the nodes; else null.
  const double* nodal_values(std::size_t i) const {
    const auto* array = std::get_if<fem::Array>(&_loads[i]->force);
    const bool given = array != nullptr && !array->per_triangle &&
                       std::holds_alternative<LoadOnTraces>(_outcomes[i]);
    return given ? array->values->data() : nullptr;
  }

  /// Integrates all loads with nodal values together, which is faster than one by one.
  Eigen::MatrixXd integrate_arrays(const ddm::Subdomain& subdomain) const {
    std::vector<const double*> arrays;
    for (std::size_t i = 0; i < _loads.size(); ++i)
      if (const double* values = nodal_values(i)) arrays.push_back(values);
    return fem::load_vectors(subdomain.part, subdomain.node, arrays);
  }

  Eigen::VectorXd integrate(std::size_t i, std::size_t s, LoadOnTraces& result) {
    const ddm::Subdomain& subdomain = _decomposition.subdomains[s];
    fem::IntegrationReport report{};
    Eigen::VectorXd of_nodes = fem::load_vector(subdomain.part, _loads[i]->force, subdomain.name,
                                                {subdomain.node, subdomain.triangle, &report,
                                                 _parts ? &result.parts.integrated[s] : nullptr});
    const std::size_t triangles = subdomain.part.triangle_count();
    judge({"the force", subdomain.name, report.relative_error_estimate,
           fem::force_tolerance(triangles), report.proof, 3 * fem::proof_tolerance(triangles)},
          _told[s][i]);
    return of_nodes;
  }

  static void judge(const Integrated& one, Told& told) {
    if (std::string warning = inexact(one); !warning.empty())
      told.warnings.push_back(std::move(warning));
    if (std::string obstacle = no_proof(one); !obstacle.empty())
      told.obstacle = std::move(obstacle);
  }

  /// Throws where a traction was given and no edge takes it.
  void require_traction_acts(const fem::Load& load) const {
    if (!acts(load.traction)) return;
    for (std::size_t s = 0; s < _decomposition.subdomains.size(); ++s)
      if (!_neumann.of(s).nodes.empty()) return;
    throw errors::Error(errors::Reason::invalid_argument,
                        "nothing has a traction, as no part of the boundary is a Neumann boundary; "
                        "name its sides or holes in the geometry's neumann, or the curves of an "
                        "uploaded mesh neumann")
        .at("traction");
  }

  /// Throws where a boundary value was given and no part of the boundary takes it.
  void require_boundary_value_acts(const fem::Load& load) const {
    if (!acts(load.boundary_value)) return;
    for (const ddm::Subdomain& subdomain : _decomposition.subdomains)
      if (subdomain.dirichlet > 0) return;
    throw errors::Error(errors::Reason::invalid_argument, no_boundary_value).at("boundary_value");
  }

  /// Lets a traction act on the length of the curve of which an edge is a chord.
  static void stretch(double by, const std::array<std::int32_t, 2>& nodes, std::size_t edge,
                      fem::TractionParts& parts, Eigen::Ref<Eigen::VectorXd> of_nodes) {
    for (const std::size_t end : {0, 1}) {
      of_nodes[nodes[end]] += by * parts.load[2 * edge + end];
      parts.load[2 * edge + end] *= 1 + by;
    }
    for (std::vector<double>* unknown : {&parts.beyond, &parts.unknown})
      if (!unknown->empty()) (*unknown)[edge] *= 1 + by;
  }

  /// Adds traction and point forces.
  void add_rest(std::size_t i, std::size_t s, LoadOnTraces& result,
                Eigen::Ref<Eigen::VectorXd> of_nodes) {
    const ddm::Subdomain& subdomain = _decomposition.subdomains[s];
    const fem::Load& load = *_loads[i];
    if (!load.traction.empty() && !_neumann.of(s).nodes.empty()) {
      const ddm::NeumannBoundary::Edges& edges = _neumann.of(s);
      fem::TractionParts own, &parts = _parts ? result.parts.traction[s] : own;
      const fem::TractionReport report =
          fem::add_traction(subdomain.part, edges.nodes, load.traction, of_nodes, &parts);
      for (std::size_t e = 0; e < edges.stretch.size(); ++e)
        stretch(edges.stretch[e], edges.nodes[e], e, parts, of_nodes);
      constexpr double enough = 1e-4;
      judge({"the traction", subdomain.name, report.relative_error_estimate,
             fem::traction_tolerance, report.proof, enough},
            _told[s][i]);
    }
    for (const NodalForce& force : _placed[i].subdomains[s]) of_nodes[force.node] += force.value;
    if (!of_nodes.allFinite()) {
      throw errors::Error(errors::Reason::invalid_argument,
                          "the load on subdomain \"{}\" overflows; scale it down", subdomain.name);
    }
  }

  std::span<const fem::Load* const> _loads;
  const ddm::Decomposition& _decomposition;
  const ddm::NeumannBoundary& _neumann;
  bool _parts;
  std::vector<PlacedForces> _placed;
  std::vector<std::vector<Told>> _told;  // (subdomains, loads)
  std::vector<CondensedOutcome> _outcomes;
};

/// The number of nodes of the largest subdomain, which is the number of rows of a block.
Eigen::Index most_nodes(const ddm::Decomposition& decomposition) {
  std::size_t most = 0;
  for (const ddm::Subdomain& subdomain : decomposition.subdomains)
    most = std::max(most, subdomain.node.size());
  return static_cast<Eigen::Index>(most);
}

}  // namespace

std::vector<CondensedOutcome> condense_loads(std::span<const fem::Load* const> loads,
                                             const mesh::Mesh& mesh,
                                             const ddm::Decomposition& decomposition,
                                             const Condense& condense,
                                             const ddm::NeumannBoundary& neumann, bool parts) {
  const auto at_once = at(ddm::columns_at_once(most_nodes(decomposition)));
  std::vector<CondensedOutcome> result;
  result.reserve(loads.size());
  for (std::size_t first = 0; first < loads.size(); first += at_once) {
    Block block(loads.subspan(first, std::min(at_once, loads.size() - first)), mesh, decomposition,
                neumann, parts);
    block.condense(condense);
    block.require_agreement(mesh);
    for (CondensedOutcome& outcome : block.take()) result.push_back(std::move(outcome));
  }
  return result;
}

}  // namespace anticrack::operators
