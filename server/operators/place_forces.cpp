// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/condense_loads.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/at.hpp"
#include "contact/least_norm.hpp"
#include "errors/errors.hpp"
#include "mesh/joined_inclusions.hpp"
#include "operators/find_points.hpp"

namespace anticrack::operators {
namespace {

using errors::Error;
using errors::Reason;

constexpr double of_rounding = 1e-12;

std::string field_of(std::size_t point) { return fmt::format("point_forces[{}]", point); }

Error refused(std::size_t index, const fem::PointForce& force, const std::string& why) {
  return Error(Reason::invalid_argument, "the point {} is {}", errors::shown(force.x, force.y), why)
      .at(field_of(index) + ".at");
}

/// The free motions (A, Bx, By) of an inclusion, in columns; held ones are not among them.
Eigen::Matrix3Xd free_motions(const ddm::Skeleton& skeleton, std::size_t inclusion) {
  const ddm::RigidMotion& motion = skeleton.motions[inclusion];
  std::map<std::int32_t, Eigen::Vector3d> columns;
  const std::array<const ddm::Terms*, 3> parts{&motion.displacement, &motion.slope_x,
                                               &motion.slope_y};
  for (Eigen::Index k = 0; k < 3; ++k)
    for (const auto& [unknown, factor] : *parts[at(k)])
      for (const auto& [free, of_unknown] : skeleton.rows[at(unknown)].free)
        columns.try_emplace(free, Eigen::Vector3d::Zero()).first->second[k] += factor * of_unknown;
  Eigen::Matrix3Xd result(3, static_cast<Eigen::Index>(columns.size()));
  Eigen::Index count = 0;
  for (const auto& [free, column] : columns) result.col(count++) = column;
  return result;
}

Eigen::Vector3d vector_of(const contact::RigidForce& force) {
  return {force.force, force.moment_x, force.moment_y};
}

/// Adds to the forces given to an inclusion, and warns of one that does no work on its free
/// motions.
void give(const contact::RigidForce& force, std::size_t inclusion, const std::string& field,
          const mesh::Mesh& mesh, const ddm::Skeleton& skeleton,
          std::vector<contact::RigidForce>& given, std::vector<std::string>& warnings) {
  add(given[inclusion], force, 1);
  const Eigen::Vector3d parts = vector_of(force);
  if (parts.isZero(0)) return;
  const Eigen::Matrix3Xd motions = free_motions(skeleton, inclusion);
  for (Eigen::Index k = 0; k < motions.cols(); ++k) {
    const Eigen::Vector3d work = motions.col(k).cwiseProduct(parts);
    if (std::abs(work.sum()) > of_rounding * work.lpNorm<1>()) return;
  }
  warnings.push_back(fmt::format("{} moves nothing: the inclusion \"{}\" {}", field,
                                 mesh.inclusions[inclusion],
                                 motions.cols() > 0 ? "does not turn that way" : "is held"));
}

void place_points(const std::vector<fem::PointForce>& forces, const mesh::Mesh& mesh,
                  const ddm::Decomposition& decomposition, PlacedForces& placed,
                  std::vector<contact::RigidForce>& given) {
  if (forces.empty()) return;
  std::vector<fem::PlanePoint> positions;
  positions.reserve(forces.size());
  for (const fem::PointForce& force : forces) positions.push_back({force.x, force.y});
  const std::vector<PointPlace> places = find_points(positions, mesh, decomposition);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const auto& [line, edge, in, location] = places[i];
    const mesh::Interface* const on = line < 0 ? nullptr : &mesh.interfaces[at(line)];
    if (on != nullptr && on->inclusion[at(edge)] >= 0) {
      const auto j = at(on->inclusion[at(edge)]);
      const ddm::RigidMotion& motion = decomposition.skeleton.motions[j];
      contact::RigidForce own{forces[i].value, 0, 0};
      if (!motion.slope_x.empty()) {
        own.moment_x = own.force * (forces[i].x - motion.centre[0]);
        own.moment_y = own.force * (forces[i].y - motion.centre[1]);
      }
      give(own, j, field_of(i), mesh, decomposition.skeleton, given, placed.warnings);
      continue;
    }
    if (on != nullptr && on->kind[at(edge)] != mesh::Kind::glue) {
      throw refused(i, forces[i],
                    "on a crack of interface \"" + on->name +
                        "\", whose sides move apart: move it to the side that is meant");
    }
    if (location.triangle < 0) throw refused(i, forces[i], "outside the membrane: move it inside");
    const ddm::Subdomain& subdomain = decomposition.subdomains[in];
    placed.points.push_back({forces[i].x, forces[i].y});
    bool held = true;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int32_t node = subdomain.part.triangles[3 * at(location.triangle) + a];
      placed.subdomains[in].push_back({node, location.weight[a] * forces[i].value});
      held = held && (location.weight[a] < of_rounding || at(node) >= subdomain.free());
    }
    if (held)
      placed.warnings.push_back(field_of(i) + " moves nothing: it acts where the boundary is held");
  }
}

/// A trace node of a body, the inclusion that has it, and its position.
struct RigidNode {
  std::size_t subdomain;
  std::int32_t node, inclusion;
  mesh::Point at;
};

/// The first inclusion of the body to which an inclusion belongs.
std::int32_t first_of_body(const ddm::Skeleton& skeleton, std::size_t inclusion) {
  return skeleton.inclusion[at(skeleton.motions[inclusion].displacement.front().index)];
}

/// The trace nodes of the inclusion's body; if `one`, just the first node of the inclusion itself.
std::vector<RigidNode> nodes_of(std::size_t inclusion, const ddm::Decomposition& decomposition,
                                bool one) {
  const std::int32_t body = first_of_body(decomposition.skeleton, inclusion);
  std::vector<RigidNode> nodes;
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const ddm::Subdomain& subdomain = decomposition.subdomains[s];
    for (std::size_t i = 0; i < subdomain.trace; ++i) {
      const std::int32_t owner = subdomain.rigid[i];
      if (owner < 0 ||
          (one ? at(owner) != inclusion : first_of_body(decomposition.skeleton, at(owner)) != body))
        continue;
      const std::size_t node = subdomain.interior + i;
      nodes.push_back({s,
                       static_cast<std::int32_t>(node),
                       owner,
                       {subdomain.part.xy[2 * node], subdomain.part.xy[2 * node + 1]}});
      if (one) return nodes;
    }
  }
  return nodes;
}

void place_on_inclusion(std::size_t inclusion, const contact::RigidForce& given,
                        const ddm::Decomposition& decomposition, PlacedForces& placed) {
  const ddm::Skeleton& skeleton = decomposition.skeleton;
  const Eigen::Matrix3Xd motions = free_motions(skeleton, inclusion);
  const bool one = skeleton.motions[inclusion].slope_x.empty();
  std::vector<RigidNode> nodes;
  if (motions.cols() > 0) nodes = nodes_of(inclusion, decomposition, one);
  const mesh::Point& centre = skeleton.motions[inclusion].centre;
  Eigen::Matrix3Xd levers(3, static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i)
    levers.col(static_cast<Eigen::Index>(i)) << 1, nodes[i].at[0] - centre[0],
        nodes[i].at[1] - centre[1];
  const Eigen::Vector3d wanted = vector_of(given);
  Eigen::VectorXd on_nodes = Eigen::VectorXd::Constant(levers.cols(), wanted[0]);
  if (!one && levers.cols() > 0) {
    on_nodes =
        contact::least_norm_solution(motions.transpose() * levers, motions.transpose() * wanted);
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const RigidNode& node = nodes[i];
    const double force = on_nodes[static_cast<Eigen::Index>(i)];
    placed.subdomains[node.subdomain].push_back({node.node, force});
    const mesh::Point& middle = skeleton.motions[at(node.inclusion)].centre;
    contact::RigidForce& sum = placed.inclusions[at(node.inclusion)].on_nodes;
    sum.force += force;
    sum.moment_x += force * (node.at[0] - middle[0]);
    sum.moment_y += force * (node.at[1] - middle[1]);
  }
  // The rest of the force does no work on the free motions; it is 0 unless the body is held.
  const std::int32_t body = first_of_body(skeleton, inclusion);
  if (std::ranges::any_of(skeleton.held,
                          [&](const auto& each) { return each.inclusion == body; })) {
    const Eigen::Vector3d left = wanted - levers * on_nodes;
    placed.inclusions[inclusion].on_holders = {left[0], left[1], left[2]};
  }
}

void add_moments(const fem::Load& load, const mesh::Mesh& mesh,
                 const ddm::Decomposition& decomposition, PlacedForces& placed,
                 std::vector<contact::RigidForce>& given) {
  for (const auto& [name, moment] : load.inclusion_moments) {
    const std::string field = "inclusion_moments[" + name + "]";
    const std::size_t j = index_of(mesh.inclusions, name, "inclusion", field);
    if (decomposition.skeleton.motions[j].slope_x.empty()) {
      const std::string why = mesh::why_none_tilts(mesh)[j];
      throw Error(Reason::invalid_argument, "a moment does nothing here: {}",
                  why.empty() ? "the inclusion \"" + name +
                                    "\" does not tilt; let it tilt, or leave the moment out"
                              : why)
          .at(field);
    }
    give({0, moment.x, moment.y}, j, field, mesh, decomposition.skeleton, given, placed.warnings);
  }
}

}  // namespace

std::size_t index_of(const std::vector<std::string>& names, const std::string& name,
                     const std::string& what, const std::string& field) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return at(found - names.begin());
  constexpr std::size_t most_listed = 20;
  std::string known;
  for (std::size_t i = 0; i < std::min(names.size(), most_listed); ++i)
    known += (known.empty() ? "\"" : ", \"") + names[i] + "\"";
  known += names.size() > most_listed ? ", ..." : "";
  throw errors::Error(errors::Reason::invalid_argument, "the mesh has no {} \"{}\"; it has {}",
                      what, name, known.empty() ? "none" : known)
      .at(field);
}

PlacedForces place_forces(const fem::Load& load, const mesh::Mesh& mesh,
                          const ddm::Decomposition& decomposition) {
  PlacedForces placed;
  placed.subdomains.resize(decomposition.subdomains.size());
  placed.inclusions.resize(mesh.inclusions.size());
  std::vector<contact::RigidForce> given(mesh.inclusions.size());
  for (const auto& [name, value] : load.inclusion_forces) {
    const std::string field = "inclusion_forces[" + name + "]";
    const std::size_t j = index_of(mesh.inclusions, name, "inclusion", field);
    give({value, 0, 0}, j, field, mesh, decomposition.skeleton, given, placed.warnings);
  }
  add_moments(load, mesh, decomposition, placed, given);
  place_points(load.point_forces, mesh, decomposition, placed, given);
  for (std::size_t j = 0; j < given.size(); ++j)
    if (!vector_of(given[j]).isZero(0)) place_on_inclusion(j, given[j], decomposition, placed);
  constexpr std::size_t most_warnings = 20;
  if (const std::size_t count = placed.warnings.size(); count > most_warnings) {
    placed.warnings.resize(most_warnings);
    placed.warnings.push_back(
        fmt::format("and {} more forces that move nothing", count - most_warnings));
  }
  return placed;
}

}  // namespace anticrack::operators
