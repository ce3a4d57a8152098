// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/place_forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "errors/errors.hpp"
#include "fem/point_location.hpp"
#include "mesh/at.hpp"
#include "operators/known_names.hpp"

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
        if (interface.kind[e] == mesh::Kind::crack) {
          found[i].crack = &interface;
        } else {
          found[i].inclusion = interface.inclusion[e];
        }
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
      placed.inclusions[at(on[i].inclusion)] += forces[i].value;
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

void place_on_inclusion(std::size_t inclusion, double force,
                        const ddm::Decomposition& decomposition, PlacedForces& placed) {
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const ddm::Subdomain& subdomain = decomposition.subdomains[s];
    const auto held = std::find(subdomain.rigid.begin(), subdomain.rigid.end(),
                                static_cast<std::int32_t>(inclusion));
    if (held != subdomain.rigid.end()) {
      const auto trace = at(held - subdomain.rigid.begin());
      placed.subdomains[s].push_back(
          {static_cast<std::int32_t>(subdomain.interior + trace), force});
      return;
    }
  }
  throw Error(Reason::internal,
              "inclusion " + std::to_string(inclusion) + " holds no node of the mesh");
}

}  // namespace

PlacedForces place_forces(const fem::Load& load, const mesh::Mesh& mesh,
                          const ddm::Decomposition& decomposition) {
  PlacedForces placed;
  placed.subdomains.resize(decomposition.subdomains.size());
  placed.inclusions.resize(mesh.inclusions.size());
  for (const auto& [name, value] : load.inclusion_forces) {
    placed.inclusions[index_of(mesh.inclusions, name, "inclusion",
                               "inclusion_forces[" + name + "]")] += value;
  }
  place_points(load.point_forces, mesh, decomposition, placed);
  for (std::size_t j = 0; j < placed.inclusions.size(); ++j)
    if (placed.inclusions[j] != 0)
      place_on_inclusion(j, placed.inclusions[j], decomposition, placed);
  return placed;
}

}  // namespace anticrack::operators
