// SPDX-License-Identifier: GPL-3.0-or-later
//
// Interfaces of glue alone must give the membrane that was never cut: the same nodes in one sparse
// solve. With any number of subdomains, cross points included.
#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <cmath>

#include "fem/load_vector.hpp"
#include "operators/mesh_operator.hpp"
#include "support/plain_stiffness.hpp"
#include "support/silent_observer.hpp"
#include "support/solve.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::operators {
namespace {

using anticrack::testing::Silent;

mesh::Kind glue(double) { return mesh::Kind::glue; }

/// Cuts one half once more along x = 0; `half` 0 lower, 1 upper. The new part is on x > 0.
void cut_half(mesh::Mesh& mesh, int half, int columns, int rows) {
  const auto name = static_cast<std::int32_t>(mesh.subdomains.size());
  mesh.subdomains.push_back(half == 0 ? "lower right" : "upper right");
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    double x = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      x += mesh.xy[2 * static_cast<std::size_t>(mesh.triangles[3 * t + k])];
    }
    if (mesh.subdomain[t] == half && x > 0) {
      mesh.subdomain[t] = name;
    }
  }
  mesh::Interface wall{half == 0 ? "lower wall" : "upper wall", {}, {}, {}};
  for (int j = half * rows; j <= (half + 1) * rows; ++j) {
    wall.nodes.push_back(j * (columns + 1) + columns / 2);
  }
  wall.kind.assign(wall.nodes.size() - 1, mesh::Kind::glue);
  wall.inclusion.assign(wall.nodes.size() - 1, -1);
  mesh.interfaces.push_back(wall);
}

/// Largest difference of the subdomains' fields from one solve on the whole mesh, and of the
/// energy.
void expect_uncut(const mesh::Mesh& mesh) {
  const fem::Load load{"load", fem::Expression{"1 + sin(4*x)*y"}, "0.3*x - y*y"};
  const auto op = MeshOperator::factorise(std::make_shared<const mesh::Mesh>(mesh), 2, {});
  contact::UzawaOptions uzawa;
  uzawa.theta.reset();
  uzawa.epsilon = 1e-30;
  uzawa.max_iterations = 200000;
  Silent observer;
  const contact::Answer exact =
      testing::solve(*op, load, contact::ActiveSetOptions{}, true, observer);
  const contact::Answer answer = testing::solve(*op, load, uzawa, true, observer);
  ASSERT_EQ(answer.status, contact::Status::converged) << answer.reason;
  ASSERT_EQ(exact.status, contact::Status::converged) << exact.reason;
  EXPECT_EQ(exact.iterations, 1);

  const fem::Triangulation whole{mesh.xy, mesh.triangles};
  const Eigen::SparseMatrix<double> stiffness = anticrack::testing::plain_stiffness(whole);
  const Eigen::VectorXd force = fem::load_vector(whole, load.force, "");
  Eigen::VectorXd prescribed =
      fem::boundary_values(whole, load.boundary_value, 0, whole.node_count());
  std::vector<char> fixed(whole.node_count(), 0);
  for (const auto& edge : mesh.dirichlet) {
    fixed[static_cast<std::size_t>(edge[0])] = fixed[static_cast<std::size_t>(edge[1])] = 1;
  }
  Eigen::SparseMatrix<double> constrained = stiffness;
  constrained.prune([&fixed](Eigen::Index i, Eigen::Index j, double) {
    return fixed[static_cast<std::size_t>(i)] == 0 && fixed[static_cast<std::size_t>(j)] == 0;
  });
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (fixed[i] != 0) {
      constrained.coeffRef(k, k) = 1;
    } else {
      prescribed[k] = 0;
    }
  }
  Eigen::VectorXd right = force - stiffness * prescribed;
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    right[k] = fixed[i] != 0 ? prescribed[k] : right[k];
  }
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(constrained);
  const Eigen::VectorXd u = solver.solve(right);

  const auto difference_of = [&u](const contact::Answer& of) {
    double difference = 0;
    for (const contact::Field& field : of.fields) {
      for (std::size_t i = 0; i < field.nodes.size(); ++i) {
        difference = std::max(difference, std::abs(field.u[i] - u[field.nodes[i]]));
      }
    }
    return difference;
  };
  const double difference = difference_of(answer);
  std::printf(
      "[ figures  ] %zu subdomains against the uncut membrane: %.1e in %d iterations, %.1e by the "
      "active set\n",
      mesh.subdomains.size(), difference, answer.iterations, difference_of(exact));
  EXPECT_LT(difference_of(exact), 1e-13);
  EXPECT_NEAR(exact.energy, u.dot(stiffness * u) / 2 - force.dot(u), 1e-12);
  EXPECT_LT(difference, 1e-11);
  EXPECT_NEAR(answer.energy, u.dot(stiffness * u) / 2 - force.dot(u), 1e-12);
  EXPECT_TRUE(answer.contact_intervals.empty());
}

TEST(UncutMembrane, IsTwoGluedHalves) {
  expect_uncut(testing::structured_mesh({24, 8, glue, {}, {}}));
}

TEST(UncutMembrane, IsThreeGluedPartsThatMeetInAPoint) {
  mesh::Mesh mesh = testing::structured_mesh({24, 8, glue, {}, {}});
  cut_half(mesh, 1, 24, 8);
  expect_uncut(mesh);
}

TEST(UncutMembrane, IsFourGluedQuartersThatMeetInAPoint) {
  mesh::Mesh mesh = testing::structured_mesh({24, 8, glue, {}, {}});
  cut_half(mesh, 0, 24, 8);
  cut_half(mesh, 1, 24, 8);
  expect_uncut(mesh);
}

TEST(UncutMembrane, IsOneSubdomainWithoutInterface) {
  mesh::Mesh mesh = testing::structured_mesh({24, 8, glue, {}, {}});
  mesh.subdomains = {"whole"};
  mesh.interfaces.clear();
  mesh.subdomain.assign(mesh.subdomain.size(), 0);
  expect_uncut(mesh);
}

TEST(UncutMembrane, MayHaveNoFreeNode) {
  auto square = std::make_shared<mesh::Mesh>();
  square->xy = {0, 0, 1, 0, 1, 1, 0, 1};
  square->triangles = {0, 1, 2, 0, 2, 3};
  square->subdomain = {0, 0};
  square->subdomains = {"square"};
  square->dirichlet = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  Silent observer;
  const auto op = MeshOperator::factorise(square, 1, {});
  for (const contact::SolverOptions& method : {contact::SolverOptions(contact::ActiveSetOptions{}),
                                               contact::SolverOptions(contact::UzawaOptions{})}) {
    const contact::Answer answer =
        testing::solve(*op, {"slope", fem::Force(0.0), "2*x"}, method, true, observer);
    EXPECT_EQ(answer.status, contact::Status::converged);
    EXPECT_NEAR(answer.energy, 2, 1e-15);  // |grad u|^2 / 2
    ASSERT_EQ(answer.fields.size(), 1U);
    for (std::size_t i = 0; i < answer.fields[0].u.size(); ++i) {
      EXPECT_EQ(answer.fields[0].u[i],
                2 * square->xy[2 * static_cast<std::size_t>(answer.fields[0].nodes[i])]);
    }
  }
}

}  // namespace
}  // namespace anticrack::operators
