// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "contact/trace_problem.hpp"
#include "fem/interface_mass.hpp"
#include "support/structured_mesh.hpp"
#include "support/trace_space.hpp"

namespace anticrack::contact {
namespace {

/// F1 + F2 by explicit elimination: S1^-1 and T (T'S2 T)^-1 T'.
Eigen::MatrixXd flexibility(const testing::TraceSpace& space) {
  const Eigen::MatrixXd s1 = space.operators[0].factor().schur();
  const Eigen::MatrixXd s2 = space.operators[1].factor().schur();
  const auto& rigid = space.decomposition.subdomains[1].rigid;
  Eigen::MatrixXd t = Eigen::MatrixXd::Zero(s2.rows(), s2.rows() + 1);
  for (Eigen::Index i = 0; i < s2.rows(); ++i) {
    t(i, rigid[static_cast<std::size_t>(i)] < 0 ? i : s2.rows()) = 1;
  }
  Eigen::MatrixXd used(t.rows(), 0);
  for (Eigen::Index j = 0; j < t.cols(); ++j) {
    if (t.col(j).sum() > 0) {
      used.conservativeResize(Eigen::NoChange, used.cols() + 1);
      used.col(used.cols() - 1) = t.col(j);
    }
  }
  return s1.inverse() + used * (used.transpose() * s2 * used).inverse() * used.transpose();
}

/// 16 columns are solved densely, 96 by Lanczos.
class ThetaStar : public ::testing::TestWithParam<int> {};

TEST_P(ThetaStar, IsTwoOverTheLargestEigenvalue) {
  const mesh::Mesh mesh = testing::structured_mesh({GetParam(), 6, {}, {}, {"bar"}});
  const testing::TraceSpace space(mesh);
  const TraceProblem problem(space.decomposition, space.operators);
  const auto& edges = space.decomposition.edges;
  const std::size_t n = space.decomposition.pairs.size();
  // Pairs and traces are numbered alike on one interface; the test would fail were they not.
  const Eigen::MatrixXd f = flexibility(space);
  for (const Mass mass : {Mass::lumped, Mass::consistent}) {
    const Eigen::MatrixXd m = mass == Mass::lumped
                                  ? Eigen::MatrixXd(fem::lumped_mass(edges, n).asDiagonal())
                                  : Eigen::MatrixXd(fem::consistent_mass(edges, n));
    const double lambda = (f * m).eigenvalues().real().maxCoeff();
    EXPECT_NEAR(problem.theta_star(mass), 2 / lambda, 1e-10);
    RecordProperty(mass == Mass::lumped ? "lumped" : "consistent",
                   std::to_string(problem.theta_star(mass)));
  }
}

INSTANTIATE_TEST_SUITE_P(Columns, ThetaStar, ::testing::Values(16, 96));

}  // namespace
}  // namespace anticrack::contact
