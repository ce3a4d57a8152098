// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/interface_mass.hpp"

namespace anticrack::fem {

Eigen::VectorXd lumped_mass(std::span<const MassEdge> edges, std::size_t n) {
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
  for (const MassEdge& edge : edges) {
    for (const std::int32_t node : edge.node)
      if (node >= 0) mass[node] += edge.length / 2;
  }
  return mass;
}

Eigen::SparseMatrix<double> consistent_mass(std::span<const MassEdge> edges, std::size_t n) {
  std::vector<Eigen::Triplet<double, std::int32_t>> entries;
  entries.reserve(4 * edges.size());
  for (const MassEdge& edge : edges) {
    for (const std::int32_t i : edge.node) {
      for (const std::int32_t j : edge.node)
        if (i >= 0 && j >= 0)
          entries.emplace_back(i, j, i == j ? edge.length / 3 : edge.length / 6);
    }
  }
  const auto size = static_cast<Eigen::Index>(n);
  Eigen::SparseMatrix<double> mass(size, size);
  mass.setFromTriplets(entries.begin(), entries.end());
  return mass;
}

}  // namespace anticrack::fem
