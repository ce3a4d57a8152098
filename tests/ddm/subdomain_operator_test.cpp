// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/subdomain_operator.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <functional>

#include "support/grid_mesh.hpp"
#include "support/plain_stiffness.hpp"
#include "support/recovered.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::ddm {
namespace {

Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

using Field = std::function<double(double, double)>;

Eigen::VectorXd at_nodes(const fem::Triangulation& part, const Field& field) {
  return Eigen::VectorXd::NullaryExpr(index(part.node_count()), [&](Eigen::Index i) {
    const auto node = 2 * static_cast<std::size_t>(i);
    return field(part.xy[node], part.xy[node + 1]);
  });
}

double zero(double, double) { return 0; }
double force(double x, double y) { return 0.001 * (std::sin(5 * x) + y); }

struct Upper {
  explicit Upper(double tension = 1)
      : decomposition([tension] {
          mesh::Mesh mesh = testing::structured_mesh({40, 12, {}, {}, {"bar"}});
          mesh.tension = {1, tension};
          return cut(mesh);
        }()) {}

  Decomposition decomposition;
  const Subdomain& subdomain = decomposition.subdomains[1];
  SubdomainOperator factorised{subdomain};
  Eigen::SparseMatrix<double> stiffness =
      anticrack::testing::plain_stiffness(subdomain.part, subdomain.tension.mean);

  CondensedLoad condense(const Field& load_of, const Field& boundary) const {
    return factorised
        .condense(load(load_of),
                  at_nodes(subdomain.part, boundary).tail(index(subdomain.dirichlet)))
        .front();
  }
  Eigen::VectorXd load(const Field& load_of) const { return at_nodes(subdomain.part, load_of); }
  Eigen::VectorXd project(const Eigen::VectorXd& g) const {
    const Flexibility& flexibility = *factorised.flexibility();
    Eigen::VectorXd reduced(flexibility.skeleton_size()), skeleton(flexibility.skeleton_size());
    Eigen::VectorXd trace(flexibility.trace_size());
    flexibility.apply(g, reduced, skeleton, trace);
    return trace;
  }
};

/// With prescribed values and without, in one block.
TEST(SubdomainOperator, CondensesLoadsTogetherAsEachAlone) {
  const Upper upper(2.5);
  const std::vector<Field> boundaries = {
      zero, [](double x, double y) { return x - 0.3 * y; }, zero,
      [](double x, double y) { return std::exp(x) * std::cos(3 * y); }};
  Eigen::MatrixXd loads(index(upper.subdomain.node.size()), 4);
  Eigen::MatrixXd dirichlet(index(upper.subdomain.dirichlet), 4);
  for (Eigen::Index j = 0; j < 4; ++j) {
    loads.col(j) = static_cast<double>(j + 1) * upper.load(force);
    dirichlet.col(j) = at_nodes(upper.subdomain.part, boundaries[static_cast<std::size_t>(j)])
                           .tail(index(upper.subdomain.dirichlet));
  }
  const std::vector<CondensedLoad> together = upper.factorised.condense(loads, dirichlet);
  ASSERT_EQ(together.size(), 4U);
  for (Eigen::Index j = 0; j < 4; ++j) {
    const CondensedLoad& a = together[static_cast<std::size_t>(j)];
    const CondensedLoad b = upper.factorised.condense(loads.col(j), dirichlet.col(j)).front();
    EXPECT_LT((a.z_interior - b.z_interior).norm(), 1e-14 * b.z_interior.norm());
    EXPECT_LT((a.g - b.g).norm(), 1e-14 * b.g.norm());
    EXPECT_LE((a.g_boundary - b.g_boundary).norm(), 1e-14 * b.g_boundary.norm());
    EXPECT_EQ(a.dirichlet, b.dirichlet);
    EXPECT_NEAR(a.energy_constant, b.energy_constant, 1e-13 * std::abs(b.energy_constant));
    EXPECT_NEAR(a.norm_constant, b.norm_constant, 1e-13 * b.norm_constant);
  }
}

TEST(SubdomainOperator, EnergyAndNormAreThoseOfTheFieldWithPrescribedValues) {
  for (const double tension : {1.0, 2.5}) {
    const Upper upper(tension);
    const std::vector<Field> boundaries = {
        zero, [](double x, double y) { return x - 0.3 * y; },
        [](double x, double y) { return std::exp(x) * std::cos(3 * y); }};
    for (const Field& boundary : boundaries) {
      const CondensedLoad load = upper.condense(force, boundary);
      const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(load.g.size(), -1, 2);
      const Eigen::VectorXd u = anticrack::testing::recovered(upper.factorised, load, t);
      const double norm = u.dot(upper.stiffness * u);
      const double energy = norm / 2 - upper.load(force).dot(u);
      const double trace_energy = t.dot(upper.factorised.factor().apply_schur(t));
      EXPECT_NEAR(trace_energy / 2 - load.g.dot(t) + load.energy_constant, energy,
                  1e-12 * std::abs(energy));
      EXPECT_NEAR(trace_energy - 2 * load.g_boundary.dot(t) + load.norm_constant, norm,
                  1e-12 * norm);
    }
  }
}

TEST(SubdomainOperator, TensionMultipliesStiffnessAndDividesTheAnswer) {
  const Upper one, tight(4);
  EXPECT_EQ((one.stiffness * 4 - tight.stiffness).norm(), 0);
  const Eigen::VectorXd g = one.condense(force, zero).g;
  EXPECT_LT((tight.condense(force, zero).g - g).norm(), 1e-13 * g.norm());
  const Eigen::VectorXd t = one.project(g);
  EXPECT_LT((4 * tight.project(g) - t).norm(), 1e-12 * t.norm());
}

TEST(SubdomainOperator, RecoversAFieldThatIsInEquilibriumInside) {
  const Upper upper;
  const CondensedLoad load = upper.condense(force, [](double x, double y) { return x + 2 * y; });
  const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(load.g.size(), 0, 1);
  const Eigen::VectorXd u = anticrack::testing::recovered(upper.factorised, load, t);
  const Eigen::VectorXd residual = upper.stiffness * u - upper.load(force);
  EXPECT_LT(residual.head(index(upper.subdomain.interior)).norm(), 1e-12);
  EXPECT_LT((u.segment(index(upper.subdomain.interior), t.size()) - t).norm(), 1e-13);
}

/// A subdomain within another: nothing but its interface holds it.
struct Island {
  explicit Island(double tension)
      : decomposition([tension] {
          testing::GridMesh grid(8, 8, {"outside", "inside"}, [](int i, int j) {
            return i >= 2 && i < 6 && j >= 2 && j < 6 ? 1 : 0;
          });
          grid.add({{2, 2}, {6, 2}, {6, 6}, {2, 6}, {2, 2}},
                   std::vector<mesh::Kind>(16, mesh::Kind::glue));
          grid.mesh.tension = {1, tension};
          return cut(grid.mesh);
        }()) {}

  Decomposition decomposition;
  const Subdomain& subdomain = decomposition.subdomains[1];
  SubdomainOperator factorised{subdomain};
};

TEST(FloatingSubdomain, HasTheExactSchurComplementAndNoFlexibility) {
  const Island island(3);
  const Eigen::Index interior = index(island.subdomain.interior);
  const Eigen::Index trace = index(island.subdomain.trace);
  ASSERT_EQ(island.subdomain.floating.size(), 1U);
  EXPECT_EQ(island.factorised.flexibility(), nullptr);
  const Eigen::MatrixXd k = anticrack::testing::plain_stiffness(island.subdomain.part, 3);
  const Eigen::MatrixXd eliminated =
      k.topLeftCorner(interior, interior).llt().solve(k.topRightCorner(interior, trace));
  const Eigen::MatrixXd dense =
      k.bottomRightCorner(trace, trace) - k.bottomLeftCorner(trace, interior) * eliminated;
  const Eigen::MatrixXd schur = island.factorised.factor().schur();
  EXPECT_LT((schur - dense).norm(), 1e-13 * dense.norm());
  EXPECT_LT(schur.rowwise().sum().norm(), 1e-13 * dense.norm());
  const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(trace, -1, 2);
  EXPECT_LT((island.factorised.factor().apply_schur(t) - dense * t).norm(), 1e-12);
  EXPECT_LT(island.factorised.factor().apply_schur(Eigen::VectorXd::Ones(trace)).norm(), 1e-12);
}

TEST(FloatingSubdomain, CondensesAndRecoversExactly) {
  const Island island(1);
  const Eigen::SparseMatrix<double> k = anticrack::testing::plain_stiffness(island.subdomain.part);
  const Eigen::VectorXd f = at_nodes(island.subdomain.part, force);
  const CondensedLoad load = island.factorised.condense(f, Eigen::VectorXd(0)).front();
  EXPECT_NEAR(load.g.sum(), f.sum(), 1e-14);  // what the interface must carry
  const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(load.g.size(), 0, 1);
  const Eigen::VectorXd u = anticrack::testing::recovered(island.factorised, load, t);
  EXPECT_LT((k * u - f).head(index(island.subdomain.interior)).norm(), 1e-13);
  EXPECT_LT((u.tail(t.size()) - t).norm(), 1e-13);
  const double energy = u.dot(k * u) / 2 - f.dot(u);
  EXPECT_NEAR(
      t.dot(island.factorised.factor().apply_schur(t)) / 2 - load.g.dot(t) + load.energy_constant,
      energy, 1e-12);
}

/// Section 6 of the paper alone, (23)-(27): membrane with a rigid inclusion on its boundary, volume
/// force and traction. The projection must be the directly constrained solve.
TEST(RigidInclusion, ProjectionEqualsTheConstrainedSolve) {
  const Upper upper;
  const Subdomain& subdomain = upper.subdomain;
  const Field slanted = [](double x, double y) { return 0.002 * (1 - 3 * x + y); };
  const Eigen::Index interior = index(subdomain.interior), trace = index(subdomain.trace);

  const CondensedLoad load = upper.condense(slanted, zero);
  Eigen::VectorXd traction(trace);  // int g v ds with a traction g on gamma_N, gamma included
  for (Eigen::Index i = 0; i < trace; ++i) {
    traction[i] = 0.05 * std::sin(0.4 * static_cast<double>(i)) + 0.01;
  }
  const Eigen::VectorXd t = upper.project(load.g + traction);
  const Eigen::VectorXd u = anticrack::testing::recovered(upper.factorised, load, t);

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
  Eigen::VectorXd f = upper.load(slanted).head(interior + trace);
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

/// Both faces and the tips of a slit in one trace: T'S T with one column for all that is rigid.
TEST(RigidInclusion, FlexibilityOfASlitIsTheConstrainedInverse) {
  testing::GridMesh grid(8, 6, {"membrane"}, [](int, int) { return 0; });
  grid.mesh.inclusions = {"bar"};
  const mesh::Kind open = mesh::Kind::delaminated;
  const Decomposition decomposition =
      cut(grid.add({{2, 3}, {6, 3}}, {open, open, open, open}, 0).mesh);
  const Subdomain& subdomain = decomposition.subdomains[0];
  const SubdomainOperator factorised(subdomain);
  const Eigen::Index n = index(subdomain.trace);
  ASSERT_EQ(n, 2 + 2 * 3);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(n, 4);
  Eigen::Index next = 1;
  for (Eigen::Index i = 0; i < n; ++i) {
    columns(i, subdomain.rigid[static_cast<std::size_t>(i)] == 0 ? 0 : next++) = 1;
  }
  ASSERT_EQ(next, 4);
  const Eigen::MatrixXd expected =
      columns * (columns.transpose() * factorised.factor().schur() * columns).inverse() *
      columns.transpose();
  const Flexibility& flexibility = *factorised.flexibility();
  EXPECT_EQ(flexibility.skeleton_size(), 4);
  Eigen::VectorXd reduced(4), skeleton(4), trace(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    flexibility.apply(Eigen::VectorXd::Unit(n, i), reduced, skeleton, trace);
    EXPECT_LT((trace - expected.col(i)).norm(), 1e-14);
    EXPECT_EQ(skeleton[3], trace[0]);  // A_0, after the free values
  }
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
