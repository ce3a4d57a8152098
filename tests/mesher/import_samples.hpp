// SPDX-License-Identifier: GPL-3.0-or-later
//
// What tests of the import ask of meshes.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <vector>

#include "mesher/import.hpp"
#include "mesher/msh_changes.hpp"
#include "mesher/msh_writer.hpp"

namespace anticrack::testing {

inline mesh::Mesh import_sample(const MshSample& sample, const mesh::MeshOptions& options = {},
                                MshFormat format = MshFormat::ascii41) {
  return mesher::to_mesh(mesher::read_msh(write_msh(sample, format), 1000), options);
}

inline void rename(MshSample& sample, int dimension, int tag, const std::string& name) {
  for (auto& n : sample.names) {
    if (n.dimension == dimension && n.tag == tag) n.name = name;
  }
}

inline std::array<double, 2> point_of(const mesh::Mesh& mesh, std::int32_t node) {
  const auto i = 2 * static_cast<std::size_t>(node);
  return {mesh.xy[i], mesh.xy[i + 1]};
}

/// The points of an interface in order.
inline std::vector<std::array<double, 2>> points_of(const mesh::Mesh& mesh, std::size_t interface) {
  std::vector<std::array<double, 2>> points;
  points.reserve(mesh.interfaces[interface].nodes.size());
  for (const std::int32_t node : mesh.interfaces[interface].nodes) {
    points.push_back(point_of(mesh, node));
  }
  return points;
}

/// Length of all interfaces of each kind.
inline std::map<mesh::Kind, double> lengths(const mesh::Mesh& mesh) {
  std::map<mesh::Kind, double> found;
  for (const mesh::Interface& interface : mesh.interfaces) {
    const std::vector<double> s = mesh::arc_length(mesh, interface);
    for (std::size_t i = 0; i + 1 < s.size(); ++i) found[interface.kind[i]] += s[i + 1] - s[i];
  }
  return found;
}

inline double area_of(const mesh::Mesh& mesh, std::size_t subdomain) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    if (mesh.subdomain[t] == static_cast<std::int32_t>(subdomain)) sum += mesh::area(mesh, t);
  }
  return sum;
}

}  // namespace anticrack::testing
