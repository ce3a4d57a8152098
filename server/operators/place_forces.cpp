// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/condense_loads.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "errors/errors.hpp"
#include "fem/point_location.hpp"
#include "mesh/at.hpp"

namespace anticrack::operators {
namespace {

using errors::Error;
using errors::Reason;

double diagonal(const mesh::Mesh& mesh) {
  fem::PlanePoint low = mesh::position(mesh, 0), high = low;
  for (std::size_t i = 0; i < mesh.xy.size(); ++i) {
    low[i % 2] = std::min(low[i % 2], mesh.xy[i]);
    high[i % 2] = std::max(high[i % 2], mesh.xy[i]);
  }
  return std::hypot(high[0] - low[0], high[1] - low[1]);
}

Error refused(std::size_t index, const fem::PointForce& force, const std::string& why) {
  std::ostringstream message;
  message.precision(17);
  message << "the point (" << force.x << ", " << force.y << ") is " << why;
  return Error(Reason::invalid_argument, message.str())
      .at("point_forces[" + std::to_string(index) + "].at");
}

/// What a point lies on of all that is not glue.
struct OnInterface {
  std::int32_t inclusion = -1;
  const mesh::Interface* crack = nullptr;
};

std::vector<OnInterface> find_on_interfaces(const mesh::Mesh& mesh, const fem::PointSet& points,
                                            double tolerance) {
  std::vector<OnInterface> found(points.size());
  for (const mesh::Interface& interface : mesh.interfaces) {
    for (std::size_t e = 0; e < interface.kind.size(); ++e) {
      if (interface.kind[e] == mesh::Kind::glue) continue;
      const std::array<fem::PlanePoint, 2> ends{mesh::position(mesh, interface.nodes[e]),
                                                mesh::position(mesh, interface.nodes[e + 1])};
      points.visit_near(ends, tolerance, [&](std::size_t i) {
        if (fem::distance_to_segment(points[i], ends[0], ends[1]) > tolerance) {
          return;
        }
        if (interface.inclusion[e] < 0)
          found[i].crack = &interface;
        else
          found[i].inclusion = interface.inclusion[e];
      });
    }
  }
  return found;
}

/// The place of each point in the subdomain where it lies deepest.
struct Placed {
  std::size_t subdomain = 0;
  fem::Location location;
};

std::vector<Placed> find_in_subdomains(const ddm::Decomposition& decomposition,
                                       const fem::PointSet& points, double tolerance) {
  std::vector<Placed> found(points.size());
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const std::vector<fem::Location> here =
        fem::locate(decomposition.subdomains[s].part, points, tolerance);
    for (std::size_t i = 0; i < here.size(); ++i)
      if (here[i].depth > found[i].location.depth) found[i] = {s, here[i]};
  }
  return found;
}

void place_points(const std::vector<fem::PointForce>& forces, const mesh::Mesh& mesh,
                  const ddm::Decomposition& decomposition, PlacedForces& placed) {
  if (forces.empty()) return;
  std::vector<fem::PlanePoint> positions;
  positions.reserve(forces.size());
  for (const fem::PointForce& force : forces) positions.push_back({force.x, force.y});
  const fem::PointSet points(positions);
  const double tolerance = point_tolerance * diagonal(mesh);
  const std::vector<OnInterface> on = find_on_interfaces(mesh, points, tolerance);
  const std::vector<Placed> in = find_in_subdomains(decomposition, points, tolerance);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    if (on[i].inclusion >= 0) {
      const auto j = at(on[i].inclusion);
      const ddm::RigidMotion& motion = decomposition.skeleton.motions[j];
      contact::RigidForce& on_inclusion = placed.inclusions[j];
      on_inclusion.force += forces[i].value;
      if (motion.slope_x.empty()) continue;
      on_inclusion.moment_x += forces[i].value * (forces[i].x - motion.centre[0]);
      on_inclusion.moment_y += forces[i].value * (forces[i].y - motion.centre[1]);
      continue;
    }
    if (on[i].crack != nullptr) {
      throw refused(i, forces[i],
                    "on a crack of interface \"" + on[i].crack->name +
                        "\", whose sides move apart: move it to the side that is meant");
    }
    const fem::Location& location = in[i].location;
    if (location.triangle < 0) throw refused(i, forces[i], "outside the membrane: move it inside");
    const ddm::Subdomain& subdomain = decomposition.subdomains[in[i].subdomain];
    for (std::size_t a = 0; a < 3; ++a) {
      placed.subdomains[in[i].subdomain].push_back(
          {subdomain.part.triangles[3 * at(location.triangle) + a],
           location.weight[a] * forces[i].value});
    }
  }
}

/// A trace node of the inclusion, and where it is from the inclusion's middle.
struct RigidNode {
  std::size_t subdomain;
  std::int32_t node;
  double x, y;
};

std::vector<RigidNode> nodes_of(std::size_t inclusion, const ddm::Decomposition& decomposition,
                                bool one) {
  const mesh::Point& centre = decomposition.skeleton.motions[inclusion].centre;
  std::vector<RigidNode> nodes;
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const ddm::Subdomain& subdomain = decomposition.subdomains[s];
    for (std::size_t i = 0; i < subdomain.trace; ++i) {
      if (at(subdomain.rigid[i]) != inclusion || subdomain.rigid[i] < 0) continue;
      const std::size_t node = subdomain.interior + i;
      nodes.push_back({s, static_cast<std::int32_t>(node), subdomain.part.xy[2 * node] - centre[0],
                       subdomain.part.xy[2 * node + 1] - centre[1]});
      if (one) return nodes;
    }
  }
  return nodes;
}

/// Forces on the nodes of least squares with the force and moment given; false if there are none.
bool balance(const std::vector<RigidNode>& nodes, const contact::RigidForce& given,
             Eigen::VectorXd& forces) {
  constexpr double rounding = 1e-9;
  double size = 0;
  for (const RigidNode& node : nodes) size = std::max({size, std::abs(node.x), std::abs(node.y)});
  if (!(size > 0)) return false;
  Eigen::Matrix3Xd rows(3, static_cast<Eigen::Index>(nodes.size()));
  for (Eigen::Index i = 0; i < rows.cols(); ++i)
    rows.col(i) << 1, nodes[at(i)].x / size, nodes[at(i)].y / size;
  const Eigen::Vector3d wanted(given.force, given.moment_x / size, given.moment_y / size);
  forces = rows.completeOrthogonalDecomposition().solve(wanted);
  return (rows * forces - wanted).norm() <= rounding * wanted.norm();
}

/// The part of a moment that does work: of a straight inclusion, that along it.
void keep_working_part(const ddm::RigidMotion& motion, contact::RigidForce& given) {
  if (motion.slope_x.size() != 1) return;
  const double x = motion.slope_x.front().factor, y = motion.slope_y.front().factor;
  const double along = (given.moment_x * x + given.moment_y * y) / (x * x + y * y);
  given.moment_x = along * x;
  given.moment_y = along * y;
}

/// `given`: replaced by what the forces on the nodes are.
void place_on_inclusion(std::size_t inclusion, const std::string& name, contact::RigidForce& given,
                        const ddm::Decomposition& decomposition, PlacedForces& placed) {
  const ddm::RigidMotion& motion = decomposition.skeleton.motions[inclusion];
  const bool tilts = !motion.slope_x.empty();
  const std::vector<RigidNode> nodes = nodes_of(inclusion, decomposition, !tilts);
  Eigen::VectorXd forces =
      Eigen::VectorXd::Constant(static_cast<Eigen::Index>(nodes.size()), given.force);
  keep_working_part(motion, given);
  if (nodes.empty() || (tilts && !balance(nodes, given, forces))) {
    throw Error(Reason::invalid_argument,
                "the inclusion \"" + name +
                    "\" has too few nodes off the Dirichlet boundary to take a force or moment; "
                    "mesh it finer, or leave them out")
        .at((given.force != 0 ? "inclusion_forces[" : "inclusion_moments[") + name + "]");
  }
  given = {};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double force = forces[static_cast<Eigen::Index>(i)];
    placed.subdomains[nodes[i].subdomain].push_back({nodes[i].node, force});
    given.force += force;
    given.moment_x += force * nodes[i].x;
    given.moment_y += force * nodes[i].y;
  }
}

void add_moments(const fem::Load& load, const mesh::Mesh& mesh,
                 const ddm::Decomposition& decomposition, PlacedForces& placed) {
  for (const auto& [name, moment] : load.inclusion_moments) {
    const std::string field = "inclusion_moments[" + name + "]";
    const std::size_t j = index_of(mesh.inclusions, name, "inclusion", field);
    if (decomposition.skeleton.motions[j].slope_x.empty()) {
      throw Error(Reason::invalid_argument,
                  "the inclusion \"" + name +
                      "\" does not tilt, so a moment on it does nothing: let it tilt, or leave the "
                      "moment out")
          .at(field);
    }
    placed.inclusions[j].moment_x += moment.x;
    placed.inclusions[j].moment_y += moment.y;
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
  throw errors::Error(
      errors::Reason::invalid_argument,
      "the mesh has no " + what + " \"" + name + "\"; it has " + (known.empty() ? "none" : known))
      .at(field);
}

PlacedForces place_forces(const fem::Load& load, const mesh::Mesh& mesh,
                          const ddm::Decomposition& decomposition) {
  PlacedForces placed;
  placed.subdomains.resize(decomposition.subdomains.size());
  placed.inclusions.resize(mesh.inclusions.size());
  for (const auto& [name, value] : load.inclusion_forces) {
    placed
        .inclusions[index_of(mesh.inclusions, name, "inclusion", "inclusion_forces[" + name + "]")]
        .force += value;
  }
  add_moments(load, mesh, decomposition, placed);
  place_points(load.point_forces, mesh, decomposition, placed);
  for (std::size_t j = 0; j < placed.inclusions.size(); ++j) {
    contact::RigidForce& force = placed.inclusions[j];
    if (force.force != 0 || force.moment_x != 0 || force.moment_y != 0)
      place_on_inclusion(j, mesh.inclusions[j], force, decomposition, placed);
  }
  return placed;
}

}  // namespace anticrack::operators
