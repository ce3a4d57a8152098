// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/interface_mass.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

namespace anticrack::fem {
namespace {

// Nodes 0, 1, 2 at 1, 3, 4 of a segment from 0 (Dirichlet) to 4 (free end).
const std::vector<MassEdge> edges = {{{-1, 0}, 1}, {{0, 1}, 2}, {{1, 2}, 1}};

TEST(InterfaceMass, LumpedIsTheLengthThatBelongsToEachNode) {
  EXPECT_EQ(lumped_mass(edges, 3), Eigen::Vector3d(1.5, 1.5, 0.5));
}

TEST(InterfaceMass, ConsistentIntegratesProductsExactly) {
  const Eigen::MatrixXd mass = consistent_mass(edges, 3);
  Eigen::Matrix3d expected;
  expected << 1, 1.0 / 3, 0, 1.0 / 3, 1, 1.0 / 6, 0, 1.0 / 6, 1.0 / 3;
  EXPECT_NEAR((mass - expected).norm(), 0, 1e-15);
  const Eigen::Vector3d s(1, 3, 4);  // int s^2 over (0,4)
  EXPECT_NEAR(s.dot(mass * s), 64.0 / 3, 1e-13);
}

}  // namespace
}  // namespace anticrack::fem
