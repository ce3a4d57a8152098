// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/find_points.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "contact/answer.hpp"
#include "operators/mesh_parts.hpp"

namespace anticrack::operators {
namespace {

double diagonal(const mesh::Mesh& mesh) {
  fem::PlanePoint low = mesh::position(mesh, 0), high = low;
  for (std::size_t i = 0; i < mesh.xy.size(); ++i) {
    low[i % 2] = std::min(low[i % 2], mesh.xy[i]);
    high[i % 2] = std::max(high[i % 2], mesh.xy[i]);
  }
  return std::hypot(high[0] - low[0], high[1] - low[1]);
}

int rank_of(const mesh::Interface& interface, std::size_t edge) {
  if (interface.inclusion[edge] >= 0) return 3;
  return interface.kind[edge] == mesh::Kind::glue ? 1 : 2;
}

}  // namespace

std::vector<PointPlace> find_points(std::span<const fem::PlanePoint> points, const mesh::Mesh& mesh,
                                    const ddm::Decomposition& decomposition) {
  const fem::PointSet set(points);
  const double tolerance = point_tolerance * diagonal(mesh);
  std::vector<PointPlace> found(points.size());
  std::vector<int> ranks(points.size(), 0);
  std::vector<double> distances(points.size());  // at tips edges are shorter than the tolerance
  for (std::size_t c = 0; c < mesh.interfaces.size(); ++c) {
    const mesh::Interface& interface = mesh.interfaces[c];
    for (std::size_t e = 0; e < interface.kind.size(); ++e) {
      const std::array<fem::PlanePoint, 2> ends{mesh::position(mesh, interface.nodes[e]),
                                                mesh::position(mesh, interface.nodes[e + 1])};
      set.visit_near(ends, tolerance, [&](std::size_t i) {
        const int rank = rank_of(interface, e);
        const double distance = fem::distance_to_segment(set[i], ends[0], ends[1]);
        if (rank < ranks[i] || distance > tolerance ||
            (rank == ranks[i] && distance > distances[i]))
          return;
        ranks[i] = rank;
        distances[i] = distance;
        found[i].interface = static_cast<std::int32_t>(c);
        found[i].edge = static_cast<std::int32_t>(e);
      });
    }
  }
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const std::vector<fem::Location> here =
        fem::locate(decomposition.subdomains[s].part, set, tolerance);
    for (std::size_t i = 0; i < here.size(); ++i) {
      if (here[i].depth <= found[i].location.depth) continue;
      found[i].subdomain = s;
      found[i].location = here[i];
    }
  }
  return found;
}

std::vector<PointPlace> MeshOperator::find_points(std::span<const mesh::Point> points) const {
  return operators::find_points(points, *_parts->mesh, _parts->decomposition);
}

std::pair<double, double> MeshOperator::u_at(const PointPlace& place, const mesh::Point& point,
                                             const contact::Answer& answer) const {
  if (place.interface >= 0) {
    const std::vector<std::int32_t>& nodes = _parts->mesh->interfaces[at(place.interface)].nodes;
    const auto i = at(place.edge);
    const mesh::Point a = mesh::position(*_parts->mesh, nodes[i]),
                      b = mesh::position(*_parts->mesh, nodes[i + 1]);
    const double dx = b[0] - a[0], dy = b[1] - a[1];
    const double along = ((point[0] - a[0]) * dx + (point[1] - a[1]) * dy) / (dx * dx + dy * dy);
    const auto read = [&](const std::vector<double>& u) {
      return std::lerp(u[i], u[i + 1], std::clamp(along, 0.0, 1.0));
    };
    const contact::Trace& trace = answer.traces[at(place.interface)];
    return {read(trace.u_minus), read(trace.u_plus)};
  }
  const ddm::Subdomain& subdomain = _parts->decomposition.subdomains[place.subdomain];
  double u = 0;
  for (std::size_t k = 0; k < 3; ++k)
    u += place.location.weight[k] *
         answer.fields[place.subdomain]
             .u[at(subdomain.part.triangles[3 * at(place.location.triangle) + k])];
  return {u, u};
}

}  // namespace anticrack::operators
