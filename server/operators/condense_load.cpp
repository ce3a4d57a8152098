// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/condense_load.hpp"

#include <sstream>

#include "errors/errors.hpp"
#include "fem/load_vector.hpp"
#include "fem/traction.hpp"
#include "operators/known_names.hpp"
#include "operators/place_forces.hpp"

namespace anticrack::operators {
namespace {

void require_known_regions(const fem::Load& load, const mesh::Mesh& mesh) {
  if (const auto* regions = std::get_if<fem::PerRegion>(&load.force)) {
    for (const auto& [name, value] : regions->values) {
      index_of(mesh.subdomains, name, "subdomain", "force.per_region[" + name + "]");
    }
  }
}

void require_array_fits(const fem::Load& load, const mesh::Mesh& mesh) {
  const auto* array = std::get_if<fem::Array>(&load.force);
  if (array == nullptr) {
    return;
  }
  const std::size_t wanted = array->per_triangle ? mesh.triangle_count() : mesh.node_count();
  const char* what = array->per_triangle ? " triangles" : " nodes";
  const std::size_t given = array->values ? array->values->size() : 0;
  if (given != wanted) {
    throw errors::Error(errors::Reason::invalid_argument,
                        "the array of the force has " + std::to_string(given) +
                            " values, but the mesh has " + std::to_string(wanted) + what +
                            ": give one value for each, in the order of ReadMesh")
        .at("force.array");
  }
}

std::string inexact(const std::string& what, const std::string& subdomain, double relative_error) {
  std::ostringstream message;
  message.precision(2);
  message << what << " on subdomain \"" << subdomain << "\" may be wrong by " << relative_error
          << " of its integral (wanted: " << fem::load_tolerance
          << "): it is too rough for the limit of evaluations";
  return message.str();
}

}  // namespace

LoadOnTraces condense_load(const fem::Load& load, const mesh::Mesh& mesh,
                           const ddm::Decomposition& decomposition,
                           std::span<const ddm::SubdomainOperator> operators,
                           const std::stop_token& stop) {
  require_known_regions(load, mesh);
  require_array_fits(load, mesh);
  PlacedForces placed = place_forces(load, mesh, decomposition);
  LoadOnTraces result;
  result.subdomains.reserve(operators.size());
  for (std::size_t s = 0; s < operators.size(); ++s) {
    const ddm::Subdomain& subdomain = decomposition.subdomains[s];
    double error = 0;
    Eigen::VectorXd of_nodes = fem::load_vector(subdomain.part, load.force, subdomain.name,
                                                {subdomain.node, subdomain.triangle, stop, &error});
    if (error > fem::load_tolerance) {
      result.warnings.push_back(inexact("the force", subdomain.name, error));
    }
    if (!load.traction.empty() && !subdomain.neumann.empty()) {
      error = fem::add_traction(subdomain.part, subdomain.neumann, load.traction, of_nodes, stop);
      if (error > fem::load_tolerance) {
        result.warnings.push_back(inexact("the traction", subdomain.name, error));
      }
    }
    for (const NodalForce& force : placed.subdomains[s]) {
      of_nodes[force.node] += force.value;
    }
    if (!of_nodes.allFinite()) {
      throw errors::Error(
          errors::Reason::invalid_argument,
          "the load on subdomain \"" + subdomain.name + "\" overflows; scale it down");
    }
    result.subdomains.push_back(operators[s].condense(
        of_nodes, fem::boundary_values(subdomain.part, load.boundary_value, subdomain.free(),
                                       subdomain.dirichlet)));
  }
  result.inclusion_forces = std::move(placed.inclusions);
  return result;
}

std::vector<std::variant<LoadOnTraces, errors::Error>> condense_loads(
    std::span<const fem::Load* const> loads, const mesh::Mesh& mesh,
    const ddm::Decomposition& decomposition, std::span<const ddm::SubdomainOperator> operators,
    const std::stop_token& stop) {
  std::vector<std::variant<LoadOnTraces, errors::Error>> result;
  result.reserve(loads.size());
  for (const fem::Load* load : loads) {
    try {
      result.emplace_back(condense_load(*load, mesh, decomposition, operators, stop));
    } catch (const errors::Error& error) {
      result.emplace_back(error);
    }
  }
  return result;
}

}  // namespace anticrack::operators
