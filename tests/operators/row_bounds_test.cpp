// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bounds of rows by shared products: against those of the same loads alone, and against finer
// meshes, also for jumps and pressures that are no solution.
#include "operators/row_bounds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "base/at.hpp"
#include "mesh/refine_uniform.hpp"
#include "operators/displacement_bounds.hpp"
#include "operators/sweep_support.hpp"
#include "reference/random_membrane.hpp"

namespace anticrack::operators {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Loads of every kind that rows share bounds for; the last is not balanced.
std::vector<fem::Load> loads_on(const mesh::Mesh& mesh, bool lifted) {
  std::vector<fem::Load> loads(3);
  loads[0].force = 1.0;
  loads[1].force = fem::Expression{"x - 2*y"};
  if (lifted) loads[1].boundary_value = "0.1*x - 0.05*y";
  if (reference::has_neumann(mesh)) loads[0].traction = "1 - 5*x";
  loads[2].force = fem::Expression{"3*sin(2*x + 5*y)"};
  const std::vector<char> tilts = reference::tilting(mesh);
  for (std::size_t j = 0; j < mesh.inclusions.size(); ++j) {
    loads[1].inclusion_forces[mesh.inclusions[j]] = j % 2 == 0 ? 0.7 : -1;
    if (tilts[j] != 0) loads[2].inclusion_moments[mesh.inclusions[j]] = {0.2, -0.3};
  }
  return loads;
}

std::vector<const fem::Load*> pointers(const std::vector<fem::Load>& loads) {
  std::vector<const fem::Load*> result;
  for (const fem::Load& load : loads) result.push_back(&load);
  return result;
}

/// A number with its bounds.
struct Known {
  double value, lower, upper;
  double width() const { return upper - lower; }
  double middle() const { return (lower + upper) / 2; }
};

/// The energy, then A of each inclusion, of the bounds that a combination has alone.
std::vector<Known> alone(const MeshOperator& op, const LoadBasis& basis,
                         std::span<const double> c) {
  const PreparedLoad load = op.combine(basis, c);
  Silent silent;
  contact::Answer answer = op.solve(load, {}, false, silent);
  if (answer.status != contact::Status::converged) return {};
  op.estimate(load, answer);
  if (!answer.energy_lower) return {};
  std::vector<Known> all{{answer.energy_mesh, *answer.energy_lower, *answer.energy_upper}};
  for (const contact::InclusionAnswer& one : answer.inclusions) {
    if (!one.displacement_lower) return {};
    all.push_back({one.displacement_mesh, *one.displacement_lower, *one.displacement_upper});
  }
  return all;
}

std::vector<Known> of_row(const contact::SweepColumns& rows, std::size_t row) {
  if (rows.status[row] != contact::Status::converged || std::isnan(rows.energy_lower[row]))
    return {};
  std::vector<Known> all{{rows.energy_mesh[row], rows.energy_lower[row], rows.energy_upper[row]}};
  for (std::size_t i = row * rows.inclusions; i < (row + 1) * rows.inclusions; ++i)
    all.push_back(
        {rows.displacement_mesh[i], rows.displacement_lower[i], rows.displacement_upper[i]});
  return all;
}

/// Both hold the same exact number.
void expect_common(const Known& a, const Known& b) {
  const double rounding = 1e-9 * (std::abs(a.value) + std::abs(b.value)) + 1e-12;
  EXPECT_LE(a.lower, b.upper + rounding);
  EXPECT_GE(a.upper, b.lower - rounding);
}

std::shared_ptr<const mesh::Mesh> refined(const mesh::Mesh& mesh, int times) {
  mesh::Mesh fine = mesh;
  for (int i = 0; i < times; ++i) fine = mesh::refine_uniform(fine);
  return std::make_shared<const mesh::Mesh>(std::move(fine));
}

double quantile(std::vector<double> values, double part) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

TEST(RowBounds, AreThoseOfTheLoadsAloneAndHoldOnFinerMeshes) {
  constexpr std::uint64_t many = 1'000'000;
  constexpr std::size_t rows_each = 8;
  std::vector<double> energies, displacements, apart;
  std::size_t contacts_changed = 0;
  for (unsigned seed = 0; seed < 24; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const reference::RandomMembrane membrane(seed, seed % 2 == 1);
    const auto mesh = refined(membrane.mesh(), 1), fine_mesh = refined(membrane.mesh(), 3);
    Operator op, fine;
    try {
      op = MeshOperator::factorise(mesh, 1, {});
      if (!op->shares_bounds(3, many)) continue;
      fine = MeshOperator::factorise(fine_mesh, 1, {});
    } catch (const errors::Error&) {
      continue;  // nothing holds a part
    }
    const std::vector<fem::Load> loads = loads_on(*mesh, true);
    const auto shared = op->basis(pointers(loads), {}, true, many);
    const auto own = op->basis(pointers(loads), {}, true),
               finer = fine->basis(pointers(loads), {}, true);
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<double> c(rows_each * loads.size());
    for (double& one : c) one = normal(random);
    contact::SweepColumns rows(rows_each, mesh->inclusions.size(), op->contact_nodes().size(),
                               contact::tilts(*mesh), true);
    std::vector<char> start;
    ASSERT_TRUE(op->sweep(*shared, c, {}, rows, start));
    for (std::size_t row = 0; row < rows_each; ++row) {
      const auto own_c = std::span(c).subspan(row * loads.size(), loads.size());
      const std::vector<Known> found = of_row(rows, row), expected = alone(*op, *own, own_c),
                               truth = alone(*fine, *finer, own_c);
      if (found.empty() || expected.empty() || truth.empty()) continue;
      const auto contact = [&](std::size_t of) {
        return std::span(rows.contact).subspan(of * rows.contacts, rows.contacts);
      };
      if (row > 0 && !std::ranges::equal(contact(row), contact(row - 1))) ++contacts_changed;
      for (std::size_t i = 0; i < found.size(); ++i) {
        SCOPED_TRACE("row " + std::to_string(row) + ", number " + std::to_string(i));
        const double size = std::abs(expected[i].value) + expected[i].width();
        EXPECT_NEAR(found[i].value, expected[i].value, 1e-9 * size);
        expect_common(found[i], expected[i]);
        expect_common(found[i], truth[i]);
        // Pi falls from mesh to mesh, but not below the exact one.
        if (i == 0) {
          EXPECT_LE(found[i].lower, truth[i].value + 1e-9 * size);
        }
        if (expected[i].width() > 1e-9 * size) {
          (i == 0 ? energies : displacements).push_back(found[i].width() / expected[i].width());
          if (i > 0)
            apart.push_back(std::abs(found[i].middle() - expected[i].middle()) /
                            expected[i].width());
        }
      }
    }
  }
  ASSERT_GT(energies.size(), 50U);
  ASSERT_GT(displacements.size(), 50U);
  EXPECT_GT(contacts_changed, 20U);
  EXPECT_LT(quantile(energies, 0.5), 1.2);
  EXPECT_LT(quantile(displacements, 0.5), 1.2);
  EXPECT_LT(quantile(energies, 0.95), 1.5);
  EXPECT_LT(quantile(apart, 0.5), 0.05);
  EXPECT_LT(quantile(displacements, 0.95), 2.5);
}

/// Loads with u = 0 on the boundary, and what rows of them share.
struct Bare {
  std::shared_ptr<const mesh::Mesh> mesh;
  MeshOperator::Parts parts;
  std::vector<LoadOnTraces> condensed;
  std::vector<BalancedLoad> balances;
  std::shared_ptr<const SharedBounds> shared;

  Bare(std::shared_ptr<const mesh::Mesh> of, const std::vector<fem::Load>& loads)
      : mesh(std::move(of)), parts(mesh, 1, default_condensed_up_to) {
    const std::vector<const fem::Load*> all = pointers(loads);
    for (CondensedOutcome& one :
         condense_loads(all, *mesh, parts.decomposition, parts.condense(), parts.neumann, true)) {
      if (const auto* error = std::get_if<errors::Error>(&one)) throw errors::Error(*error);
      condensed.push_back(std::get<LoadOnTraces>(std::move(one)));
    }
    balances = balanced(all, condensed, parts.decomposition.subdomains, parts.cut_mesh());
    std::vector<contact::CaseLoads> cases;
    for (const LoadOnTraces& load : condensed)
      cases.push_back({load.subdomains, load.inclusion_forces});
    const auto count = static_cast<Index>(cases.size());
    const contact::SweepLoads reduced =
        contact::reduce(*parts.contact, cases, Eigen::MatrixXd::Zero(count, count));
    shared = shared_bounds(parts, condensed, balances, reduced);
  }

  /// Bounds from jumps d >= 0 and pressures lambda >= 0 of the load c, which need not solve it.
  std::vector<Known> bounds(const VectorXd& c, const VectorXd& d, const VectorXd& lambda) const {
    const SharedBounds& of = *shared;
    contact::LcpAnswer answer;
    answer.d = d;
    answer.lambda = lambda;
    for (Index i = 0; i < d.size(); ++i) answer.closed.push_back(d[i] > 0 ? 0 : 1);
    contact::SweepColumns rows(1, mesh->inclusions.size(), 0, false, true);
    rows.status[0] = contact::Status::converged;
    rows.energy[0] = -0.5 * c.dot(of.strain.topLeftCorner(of.loads, of.loads) * c) -
                     d.dot(of.r * c) + 0.5 * d.dot(of.stiffness() * d);
    for (Index k = 0; k < of.goals; ++k)
      rows.displacement[of.inclusion[at(k)]] =
          of.strain.col(of.loads + of.contacts + k).head(of.loads).dot(c) + of.unit[at(k)].r.dot(d);
    RowBounds(parts, of).find({c.data(), at(c.size())}, answer, 0, rows);
    return of_row(rows, 0);
  }
};

/// The distance by products is that of the flux which a fan makes that divides its forces so.
TEST(RowBounds, TakeProductsOfTheFluxesThemselves) {
  std::size_t tested = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const reference::RandomMembrane membrane(seed, seed % 2 == 1);
    const auto mesh = refined(membrane.mesh(), 0);
    std::optional<Bare> bare;
    try {
      bare.emplace(mesh, loads_on(*mesh, true));
    } catch (const errors::Error&) {
      continue;
    }
    if (!bare->shared) continue;
    const SharedBounds& of = *bare->shared;
    const MeshOperator::Parts& parts = bare->parts;
    const estimate::CutMesh& cut = parts.cut_mesh();
    for (Index j = 0; j < of.loads; ++j) {
      const VectorXd d = VectorXd::Random(of.contacts), lambda = of.stiffness() * d - of.r.col(j);
      const LoadOnTraces& load = bare->condensed[at(j)];
      const contact::Reduced closed = parts.contact->reduce(
          load.subdomains, contact::held_values(parts.decomposition, load.subdomains), true);
      contact::Answer answer;
      for (const VectorXd& trace : parts.problem.scatter(
               parts.contact->values(parts.contact->solve(closed, d), d, closed.p)))
        answer.side_traces.emplace_back(trace.begin(), trace.end());
      const contact::SolvedCase solved{load.subdomains, answer};
      parts.contact->recover_fields({&solved, 1});
      const std::vector<double> u = of_copies(answer.fields);
      std::vector<double> through(2 * cut.faces.size(), 0);
      auto end = of.ends.begin();
      for (std::size_t f = 0; f < cut.faces.size(); ++f) {
        if (!estimate::presses(cut.faces[f].condition)) continue;
        for (const std::size_t k : {0, 1}) {
          if (end->force >= 0) through[2 * f + k] = -end->part * lambda[end->force];
          ++end;
        }
      }
      const estimate::LoadBalance& balance = bare->balances[at(j)].balance;
      const estimate::EquilibratedFlux flux(cut, {u, balance.force, balance.traction},
                                            {through, through});
      double distance = 0;
      for (const double one : flux.distance()) distance += one;
      VectorXd y = VectorXd::Zero(of.flux.rows());
      y[j] = 1;
      y.segment(of.loads, of.contacts) = d;
      EXPECT_NEAR(y.dot(of.flux * y), distance, 1e-9 * (distance + flux.norm_squared()));
      EXPECT_NEAR(y.dot(of.strain * y), flux.norm_squared(), 1e-9 * flux.norm_squared());
      ++tested;
    }
  }
  EXPECT_GT(tested, 9U);
}

/// Jumps of no solution, pushed apart by pressures that no load has: without int p [u], or with an
/// adjoint outside its cone, bounds would miss.
TEST(RowBounds, HoldForJumpsAndPressuresThatAreNoSolution) {
  std::size_t tested = 0;
  for (unsigned seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const reference::RandomMembrane membrane(seed);
    const auto mesh = refined(membrane.mesh(), 1);
    const std::vector<fem::Load> loads = loads_on(*mesh, false);
    std::optional<Bare> bare;
    Operator fine;
    try {
      bare.emplace(mesh, loads);
      if (!bare->shared) continue;
      fine = MeshOperator::factorise(refined(membrane.mesh(), 3), 1, {});
    } catch (const errors::Error&) {
      continue;
    }
    const auto finer = fine->basis(pointers(loads), {}, true);
    const SharedBounds& of = *bare->shared;
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    for (int row = 0; row < 4; ++row) {
      const VectorXd c = VectorXd::NullaryExpr(of.loads, [&] { return normal(random); });
      const std::vector<Known> truth = alone(*fine, *finer, {c.data(), at(c.size())});
      if (truth.empty()) continue;
      // d = max(S^-1 r, 0) is no solution; forces on all contacts lift it until S d - r > 0.
      VectorXd d = (of.softness * (of.r * c)).cwiseMax(0.0);
      const VectorXd r = of.r * c, missing = (r - of.stiffness() * d).cwiseMax(0.0);
      const VectorXd& mass = bare->parts.problem.pair_forces().contact_mass();
      const double push = row * r.lpNorm<1>() / mass.sum();  // a pressure
      d += of.softness * (missing + push * mass);
      const VectorXd lambda = (of.stiffness() * d - r).cwiseMax(0.0);
      const std::vector<Known> found = bare->bounds(c, d.cwiseMax(0.0), lambda);
      if (found.empty()) continue;
      ++tested;
      for (std::size_t i = 0; i < found.size(); ++i) {
        SCOPED_TRACE("row " + std::to_string(row) + ", number " + std::to_string(i));
        expect_common(found[i], truth[i]);
      }
      EXPECT_LE(found[0].lower, truth[0].value + 1e-9 * std::abs(truth[0].value));
    }
  }
  EXPECT_GT(tested, 40U);
}

/// Waves that no triangle sees: on the mesh there is next to no load.
TEST(RowBounds, HoldForALoadThatIsNotBalanced) {
  fem::Load wave;
  wave.force = fem::Expression{"100*cos(24*acos(-1)*x)"};
  fem::Load smooth;
  smooth.force = 0.01;
  const std::vector<fem::Load> loads{wave, smooth};
  const mesh::Mesh coarse = testing::structured_mesh({8, 2, {}, {}, {"bar"}});
  const Bare bare(std::make_shared<const mesh::Mesh>(coarse), loads);
  ASSERT_TRUE(bare.shared);
  const Operator fine = MeshOperator::factorise(refined(coarse, 4), 1, {});
  const auto finer = fine->basis(pointers(loads), {}, true);
  const VectorXd c = VectorXd::Ones(2);
  const SharedBounds& of = *bare.shared;
  const contact::LcpAnswer solution = bare.parts.contact->solve_contact(
      {{}, {}, {}, of.r * c, (of.r * c).cwiseAbs(), 1}, {}, {}, {});
  const std::vector<Known> found = bare.bounds(c, solution.d, solution.lambda),
                           truth = alone(*fine, *finer, {c.data(), 2});
  ASSERT_FALSE(found.empty() || truth.empty());
  for (std::size_t i = 0; i < found.size(); ++i) expect_common(found[i], truth[i]);
  // What is balanced alone would not reach the energy.
  EXPECT_LT(truth[0].value, 2 * found[0].value);
}

TEST(RowBounds, DoNotDependOnOtherRows) {
  const Operator op = MeshOperator::factorise(
      std::make_shared<const mesh::Mesh>(testing::structured_mesh({64, 16, {}, {}, {"bar"}})), 1,
      {});
  const std::vector<fem::Load> loads = loads_on(op->mesh(), true);
  constexpr std::size_t count = 12;
  ASSERT_TRUE(op->shares_bounds(3, 1'000'000));
  EXPECT_FALSE(op->shares_bounds(3, 1));
  const auto basis = op->basis(pointers(loads), {}, true, 1'000'000);
  std::vector<double> c(3 * count);
  std::mt19937 random(1);
  for (double& one : c) one = std::normal_distribution<double>()(random);
  const auto columns = [&](std::size_t rows) {
    return contact::SweepColumns(rows, 1, op->contact_nodes().size(), false, true);
  };
  contact::SweepColumns together = columns(count);
  std::vector<char> start;
  ASSERT_TRUE(op->sweep(*basis, c, {}, together, start));
  for (std::size_t row = 0; row < count; ++row) {
    contact::SweepColumns one = columns(1);
    start.clear();
    ASSERT_TRUE(op->sweep(*basis, std::span(c).subspan(3 * row, 3), {}, one, start));
    EXPECT_EQ(one.energy_lower[0], together.energy_lower[row]);
    EXPECT_EQ(one.displacement_lower[0], together.displacement_lower[row]);
    EXPECT_EQ(one.displacement_upper[0], together.displacement_upper[row]);
  }
}

}  // namespace
}  // namespace anticrack::operators
