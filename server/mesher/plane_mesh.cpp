// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/precision.hpp"
#include "mesher/import_steps.hpp"
#include "mesher/messages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace anticrack::mesher {
namespace {

/// Rounding in z of a plane geometry that was rotated or scaled, relative to its size.
constexpr double plane_tolerance = 1e-9;
/// Keeps squares of lengths and their sums finite.
constexpr double largest_coordinate = 1e100;

double area(const std::vector<double>& xy, const std::array<std::int32_t, 3>& nodes) {
  const auto x = [&](std::size_t i) { return xy[2 * at(nodes[i])]; };
  const auto y = [&](std::size_t i) { return xy[2 * at(nodes[i]) + 1]; };
  return 0.5 * ((x(1) - x(0)) * (y(2) - y(0)) - (y(1) - y(0)) * (x(2) - x(0)));
}

/// Sets mesh.of to 0 for nodes of triangles, to -1 for others.
void find_used(const MshFile& file, PlaneMesh& mesh) {
  mesh.of.reserve(file.node_tags.size());
  for (const std::uint64_t tag : file.node_tags)
    if (!mesh.of.emplace(tag, -1).second)
      refuse("node {} is defined twice; save the mesh again", tag);
  for (const auto& t : file.triangles) {
    for (const std::uint64_t tag : t.nodes) {
      const auto found = mesh.of.find(tag);
      if (found == mesh.of.end()) {
        refuse("triangle {} has node {}, which the file does not define; save the mesh again",
               t.tag, tag);
      }
      found->second = 0;
    }
  }
}

/// The common z of the used nodes.
double plane_of(const MshFile& file, const PlaneMesh& mesh) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::array<double, 3> low{infinity, infinity, infinity};
  std::array<double, 3> high{-infinity, -infinity, -infinity};
  std::array<std::uint64_t, 2> lowest_highest{};
  for (std::size_t i = 0; i < file.node_tags.size(); ++i) {
    if (mesh.of.at(file.node_tags[i]) < 0) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const double value = file.xyz[3 * i + k];
      if (std::abs(value) > largest_coordinate) {
        refuse("node {} has a coordinate of {:g}; choose a larger unit of length",
               file.node_tags[i], value);
      }
      if (k == 2 && value < low[2]) lowest_highest[0] = file.node_tags[i];
      if (k == 2 && value > high[2]) lowest_highest[1] = file.node_tags[i];
      low[k] = std::min(low[k], value);
      high[k] = std::max(high[k], value);
    }
  }
  const double extent = std::max(high[0] - low[0], high[1] - low[1]);
  const double largest = std::max({-low[0], -low[1], high[0], high[1]});
  if (extent < mesh::least_extent * largest) {
    refuse(
        "the mesh is {:g} across, but lies {:g} from the origin: too far for double precision; "
        "move "
        "it to the origin",
        extent, largest);
  }
  if (high[2] - low[2] > plane_tolerance * extent) {
    refuse("node {} lies at z = {:g}, node {} at z = {:g}; a membrane lies in a plane of one z",
           lowest_highest[0], low[2], lowest_highest[1], high[2]);
  }
  return std::abs(high[2]) > plane_tolerance * extent ? high[2] : 0;
}

void take_nodes(const MshFile& file, PlaneMesh& mesh) {
  for (std::size_t i = 0; i < file.node_tags.size(); ++i) {
    std::int32_t& place = mesh.of.at(file.node_tags[i]);
    if (place < 0) continue;
    place = static_cast<std::int32_t>(mesh.tags.size());
    mesh.tags.push_back(file.node_tags[i]);
    mesh.xy.push_back(file.xyz[3 * i]);
    mesh.xy.push_back(file.xyz[3 * i + 1]);
  }
  const std::size_t unused = file.node_tags.size() - mesh.tags.size();
  if (unused > 0) {
    mesh.warnings.push_back(fmt::format(
        "{} to no triangle left out",
        unused == 1 ? "1 node that belongs" : fmt::format("{} nodes that belong", unused)));
  }
}

void take_triangles(const MshFile& file, PlaneMesh& mesh) {
  std::size_t turned = 0;
  mesh.triangles.reserve(3 * file.triangles.size());
  for (const auto& t : file.triangles) {
    std::array<std::int32_t, 3> nodes{mesh.of.at(t.nodes[0]), mesh.of.at(t.nodes[1]),
                                      mesh.of.at(t.nodes[2])};
    if (area(mesh.xy, nodes) < 0) {
      std::swap(nodes[1], nodes[2]);
      ++turned;
    }
    if (!(area(mesh.xy, nodes) > 0)) {
      const auto i = 2 * at(nodes[0]);
      refuse("triangle {} at ({:g}, {:g}) has no area; mesh again", t.tag, mesh.xy[i],
             mesh.xy[i + 1]);
    }
    mesh.triangles.insert(mesh.triangles.end(), nodes.begin(), nodes.end());
  }
  if (turned > 0) {
    mesh.warnings.push_back(
        fmt::format("{} clockwise, turned round",
                    turned == 1 ? "1 triangle was" : fmt::format("{} triangles were", turned)));
  }
}

}  // namespace

PlaneMesh read_plane(const MshFile& file) {
  if (file.triangles.empty()) {
    refuse(
        "the mesh has no triangle; mesh in two dimensions (gmsh -2) and put the surfaces in "
        "physical groups before saving");
  }
  if (file.node_tags.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    refuse("the mesh has {} nodes, too many to number", file.node_tags.size());
  PlaneMesh mesh;
  find_used(file, mesh);
  const double z = plane_of(file, mesh);
  if (z != 0) mesh.warnings.push_back(fmt::format("the mesh lies at z = {:g}: taken for z = 0", z));
  take_nodes(file, mesh);
  take_triangles(file, mesh);
  return mesh;
}

}  // namespace anticrack::mesher
