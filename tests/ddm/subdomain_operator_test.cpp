// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/subdomain_operator.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>

#include "fem/load_vector.hpp"
#include "fem/stiffness.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::ddm {
namespace {

Eigen::Index index(std::size_t i) {
  return static_cast<Eigen::Index>(i);
}

struct Upper {
  Decomposition decomposition = cut(testing::structured_mesh({40, 12, {}, {}, {"bar"}}));
  const Subdomain& subdomain = decomposition.subdomains[1];
  SubdomainOperator factorised{subdomain};
  Eigen::SparseMatrix<double> stiffness = fem::stiffness(subdomain.part);

  CondensedLoad condense(const char* force, const char* boundary) const {
    return factorised.condense(
        load(force),
        fem::boundary_values(subdomain.part, boundary, subdomain.free(), subdomain.dirichlet));
  }
  Eigen::VectorXd load(const char* force) const {
    return fem::load_vector(subdomain.part, fem::Expression{force}, subdomain.name);
  }
  Eigen::VectorXd project(const Eigen::VectorXd& g) const {
    const Flexibility& flexibility = factorised.flexibility();
    Eigen::VectorXd reduced(flexibility.skeleton_size()), skeleton(flexibility.skeleton_size());
    Eigen::VectorXd trace(flexibility.trace_size());
    flexibility.apply(g, reduced, skeleton, trace);
    return trace;
  }
};

TEST(SubdomainOperator, EnergyAndNormAreThoseOfTheFieldWithPrescribedValues) {
  const Upper upper;
  for (const char* boundary : {"", "x - 0.3*y", "exp(x)*cos(3*y)"}) {
    const CondensedLoad load = upper.condense("sin(5*x) + y", boundary);
    const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(load.g.size(), -1, 2);
    const Eigen::VectorXd u = upper.factorised.recover(load, t);
    const double norm = u.dot(upper.stiffness * u);
    const double energy = norm / 2 - upper.load("sin(5*x) + y").dot(u);
    const double trace_energy = t.dot(upper.factorised.factor().apply_schur(t));
    EXPECT_NEAR(trace_energy / 2 - load.g.dot(t) + load.energy_constant, energy,
                1e-12 * std::abs(energy))
        << boundary;
    EXPECT_NEAR(trace_energy - 2 * load.g_boundary.dot(t) + load.norm_constant, norm, 1e-12 * norm)
        << boundary;
  }
}

TEST(SubdomainOperator, RecoversAFieldThatIsInEquilibriumInside) {
  const Upper upper;
  const CondensedLoad load = upper.condense("1 + x*y", "x + 2*y");
  const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(load.g.size(), 0, 1);
  const Eigen::VectorXd u = upper.factorised.recover(load, t);
  const Eigen::VectorXd residual = upper.stiffness * u - upper.load("1 + x*y");
  EXPECT_LT(residual.head(index(upper.subdomain.interior)).norm(), 1e-12);
  EXPECT_LT((u.segment(index(upper.subdomain.interior), t.size()) - t).norm(), 1e-13);
}

/// Section 6 of the paper alone, (23)-(27): membrane with a rigid inclusion on its boundary, volume
/// force and traction. The projection must be the directly constrained solve.
TEST(RigidInclusion, ProjectionEqualsTheConstrainedSolve) {
  const Upper upper;
  const Subdomain& subdomain = upper.subdomain;
  const Eigen::Index interior = index(subdomain.interior), trace = index(subdomain.trace);

  const CondensedLoad load = upper.condense("1 - 3*x + y", "");
  Eigen::VectorXd traction(trace);  // int g v ds with a traction g on gamma_N, gamma included
  for (Eigen::Index i = 0; i < trace; ++i) {
    traction[i] = 0.05 * std::sin(0.4 * static_cast<double>(i)) + 0.01;
  }
  const Eigen::VectorXd t = upper.project(load.g + traction);
  const Eigen::VectorXd u = upper.factorised.recover(load, t);

  // Directly: one unknown A for all nodes of the inclusion.
  std::vector<Eigen::Triplet<double>> ones;
  Eigen::Index columns = 0;
  for (Eigen::Index i = 0; i < interior + trace; ++i) {
    if (i < interior || subdomain.rigid[static_cast<std::size_t>(i - interior)] < 0) {
      ones.emplace_back(i, columns++, 1.0);
    }
  }
  for (Eigen::Index i = 0; i < trace; ++i) {
    if (subdomain.rigid[static_cast<std::size_t>(i)] == 0) {
      ones.emplace_back(interior + i, columns, 1.0);
    }
  }
  Eigen::SparseMatrix<double> constraint(interior + trace, columns + 1);
  constraint.setFromTriplets(ones.begin(), ones.end());
  const Eigen::SparseMatrix<double> free =
      upper.stiffness.topLeftCorner(interior + trace, interior + trace);
  const Eigen::SparseMatrix<double> reduced = constraint.transpose() * free * constraint;
  Eigen::VectorXd f = upper.load("1 - 3*x + y").head(interior + trace);
  f.tail(trace) += traction;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(reduced);
  const Eigen::VectorXd direct = constraint * solver.solve(constraint.transpose() * f).eval();

  const double difference = (u.head(interior + trace) - direct).lpNorm<Eigen::Infinity>() /
                            direct.lpNorm<Eigen::Infinity>();
  // (27): int_gamma du/dn ds = int_gamma g ds
  double resultant = 0;
  const Eigen::VectorXd flux = upper.factorised.factor().apply_schur(t) - load.g - traction;
  for (Eigen::Index i = 0; i < trace; ++i) {
    resultant += subdomain.rigid[static_cast<std::size_t>(i)] == 0 ? flux[i] : 0.0;
  }
  RecordProperty("difference", std::to_string(difference));
  std::printf("[ figures  ] projection against constrained solve: %.2e; resultant: %.2e\n",
              difference, resultant);
  EXPECT_LT(difference, 1e-12);
  EXPECT_LT(std::abs(resultant), 1e-13);
}

TEST(RigidInclusion, FlexibilityIsSymmetricAndHoldsTheInclusionConstant) {
  const Upper upper;
  const Eigen::Index n = index(upper.subdomain.trace);
  Eigen::MatrixXd f(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    f.col(i) = upper.project(Eigen::VectorXd::Unit(n, i));
  }
  EXPECT_LT((f - f.transpose()).norm(), 1e-13 * f.norm());
  for (Eigen::Index i = 1; i < n; ++i) {
    if (upper.subdomain.rigid[static_cast<std::size_t>(i)] == 0 &&
        upper.subdomain.rigid[static_cast<std::size_t>(i - 1)] == 0) {
      EXPECT_EQ(f.row(i), f.row(i - 1));
    }
  }
}

}  // namespace
}  // namespace anticrack::ddm
