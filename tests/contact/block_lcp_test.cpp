// SPDX-License-Identifier: GPL-3.0-or-later
//
// The contact problem by blocks against the dense one, on cracks that are cut into several blocks.
#include "contact/block_lcp.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "contact/joined_problem.hpp"
#include "contact/membrane.hpp"
#include "contact/open_membrane.hpp"
#include "support/grid_mesh.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using mesh::Kind;

constexpr int length = 1200, height = 8;

/// A strip of `length` squares with one crack or delaminated inclusion along nearly all of it.
mesh::Mesh strip_with(Kind kind) {
  testing::GridMesh grid(length, height, {"all"}, [](int, int) { return 0; });
  if (kind == Kind::delaminated) {
    grid.mesh.inclusions = {"stiffener"};
    grid.mesh.motions = {{true, {}}};
  }
  grid.add({{20, height / 2}, {length - 20, height / 2}}, std::vector<Kind>(length - 40, kind), 0);
  return std::move(grid.mesh);
}

/// Short cracks cross the long one: the conditions of the cross points depend on each other.
mesh::Mesh crossed_strip() {
  testing::GridMesh grid(length, height, {"all"}, [](int, int) { return 0; });
  grid.add({{20, height / 2}, {length - 20, height / 2}},
           std::vector<Kind>(length - 40, Kind::crack));
  for (int x = 100; x < length; x += 250)
    grid.add({{x, 2}, {x, height - 2}}, std::vector<Kind>(height - 4, Kind::crack));
  return std::move(grid.mesh);
}

/// A strip solved both ways.
class Strip {
 public:
  explicit Strip(mesh::Mesh mesh) : _dense(std::move(mesh)), _joined(_dense.problem, 2, 0) {}

  Reduced reduce(const char* force) const {
    const ddm::Decomposition& decomposition = _dense.space.decomposition;
    std::vector<ddm::CondensedLoad> loads;
    for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
      const ddm::Subdomain& part = decomposition.subdomains[s];
      loads.push_back(
          _joined
              .loads(s, fem::load_vector(part.part, fem::Expression{force}, part.name),
                     fem::boundary_values(part.part, "0.1*y", part.free(), part.dirichlet))
              .front());
    }
    return _joined.reduce(loads, held_values(decomposition, loads));
  }
  const CondensedProblem& condensed() const { return _dense.condensed; }
  const JoinedProblem& joined() const { return _joined; }
  const DenseLcp& dense() const { return _dense.condensed.lcp(); }
  const BlockLcp& blocks() const { return _joined.by_blocks(); }
  const JoinedMembrane& membrane() const { return _joined.membrane(); }
  const PairForces& forces() const { return _dense.problem.pair_forces(); }

 private:
  Membrane _dense;
  JoinedProblem _joined;
};

/// Waves along the crack that open it here and close it there; one that opens nearly all of it.
const char* const waves[] = {"(y - 4)*sin(0.02*x)", "(y - 4)*sin(0.3*x) + 0.1*cos(0.011*x)",
                             "(y > 4 ? 1 : -1)*(1 - (x/1200)^8)", "0.3*sin(0.05*x)*(y > 4 ? 1 : 0)",
                             "(4 - y)"};

/// Relative to the largest.
double difference(const VectorXd& a, const VectorXd& b) {
  const double size = std::max(a.lpNorm<Eigen::Infinity>(), b.lpNorm<Eigen::Infinity>());
  return size == 0 ? 0 : (a - b).lpNorm<Eigen::Infinity>() / size;
}

struct Named {
  const char* name;
  mesh::Mesh (*make)();
};
class LongCrack : public ::testing::TestWithParam<Named> {};

TEST_P(LongCrack, HasTheAnswersOfTheDenseProblem) {
  const Strip strip(GetParam().make());
  const ContactBlocks cut(strip.membrane(), strip.forces(), 2);
  ASSERT_GT(strip.dense().size(), 1000);
  ASSERT_GE(cut.blocks().size(), 3U);
  ASSERT_GT(cut.hats().cols(), 2);
  std::mt19937 random(1);
  for (const char* wave : waves) {
    SCOPED_TRACE(wave);
    const Reduced load = strip.reduce(wave);
    const LcpAnswer dense = strip.dense().solve(load.r, load.magnitude, {}, {});
    ASSERT_EQ(dense.status, LcpStatus::solved);
    std::vector<std::vector<char>> starts = {{}, dense.closed};
    starts.emplace_back(dense.closed.size());
    for (char& closed : starts.back()) closed = static_cast<char>(random() % 2);
    for (const std::vector<char>& start : starts) {
      const LcpAnswer answer = strip.blocks().solve(load.r, load.magnitude, {}, start);
      ASSERT_EQ(answer.status, LcpStatus::solved);
      const auto opened = std::ranges::count(answer.closed, 0);
      std::printf(
          "[ figures  ] %s, %s: %zd of %zu open, %d steps, %d solves, residual %.1e; d %.1e, "
          "lambda %.1e\n",
          GetParam().name, wave, static_cast<std::ptrdiff_t>(opened), answer.closed.size(),
          answer.steps, answer.solves, answer.residual, difference(answer.d, dense.d),
          difference(answer.lambda, dense.lambda));
      EXPECT_EQ(answer.closed, dense.closed);
      EXPECT_EQ(answer.pressed, dense.pressed);
      EXPECT_EQ(answer.weakly_active, dense.weakly_active);
      EXPECT_LT(difference(answer.d, dense.d), 1e-10);
      EXPECT_LT(difference(answer.lambda, dense.lambda), 1e-10);
      EXPECT_LT(answer.residual, 1e-10);
      EXPECT_LT(answer.solves, 250);
    }
  }
}

/// S^ is that of the dense problem.
TEST_P(LongCrack, AppliesTheMatrixOfTheDenseProblem) {
  const Strip strip(GetParam().make());
  const VectorXd d = VectorXd::Random(strip.dense().size());
  const VectorXd scale = strip.dense().scale().head(d.size());
  const VectorXd wanted =
      (strip.dense().scaled_matrix() * d.cwiseQuotient(scale)).cwiseQuotient(scale);
  EXPECT_LT(difference(strip.membrane().apply(d, true), wanted), 1e-12);
}

/// What adjoints are made of: open contacts whatever the sign of their jumps.
TEST_P(LongCrack, HasTheLinearAnswersOfTheDenseProblem) {
  const Strip strip(GetParam().make());
  const ddm::Skeleton& skeleton = strip.membrane().decomposition().skeleton;
  const ddm::Terms on = skeleton.motions.empty() ? ddm::Terms{{skeleton.contacts[500].minus, 1}}
                                                 : skeleton.motions.front().displacement;
  const UnitForce force = strip.condensed().unit_force(on), other = strip.joined().unit_force(on);
  EXPECT_NEAR(other.compliance, force.compliance, 1e-10 * force.compliance);
  EXPECT_LT(difference(other.r, force.r), 1e-10);
  const Reduced load = strip.reduce(waves[0]);
  const std::vector<char> closed = strip.dense().solve(load.r, load.magnitude, {}, {}).closed;
  for (const std::vector<char>& kept : {closed, std::vector<char>()}) {
    const Opened dense = strip.condensed().solve_open(kept, {&force.r, 1}, 0).front();
    const Opened joined = strip.joined().solve_open(kept, {&force.r, 1}, 0).front();
    ASSERT_TRUE(dense.solved && joined.solved);
    std::printf("[ figures  ] %s: d %.1e, reactions %.1e of %.1e\n", GetParam().name,
                (joined.d - dense.d).lpNorm<Eigen::Infinity>() / force.compliance,
                (joined.residual - dense.residual).lpNorm<Eigen::Infinity>(),
                force.r.lpNorm<Eigen::Infinity>());
    EXPECT_LT((joined.d - dense.d).lpNorm<Eigen::Infinity>(), 1e-9 * force.compliance);
    EXPECT_LT((joined.residual - dense.residual).lpNorm<Eigen::Infinity>(),
              1e-9 * force.r.lpNorm<Eigen::Infinity>());
    const Displaced displaced{&on, dense.d};
    const std::vector<double> u = strip.condensed().fields_of({&displaced, 1}).front(),
                              v = strip.joined().fields_of({&displaced, 1}).front();
    EXPECT_LT(difference(VectorXd::Map(u.data(), static_cast<Index>(u.size())),
                         VectorXd::Map(v.data(), static_cast<Index>(v.size()))),
              1e-9);
  }
}

/// Bits of a force do not depend on how many are solved with it.
TEST_P(LongCrack, HasTheFieldsOfUnitForcesWithEveryContactOpen) {
  const Strip strip(GetParam().make());
  const ddm::Skeleton& skeleton = strip.membrane().decomposition().skeleton;
  std::vector<ddm::Terms> sums;
  for (const ddm::RigidMotion& motion : skeleton.motions) sums.push_back(motion.displacement);
  for (const std::size_t c : {3, 200, 500, 700, 1001})
    sums.push_back({{skeleton.contacts[c].minus, 1}, {skeleton.contacts[c].plus, -0.5}});
  std::vector<const ddm::Terms*> forces;
  for (const ddm::Terms& sum : sums) forces.push_back(&sum);
  const OpenMembrane open(strip.membrane());
  const std::vector<std::vector<double>> fields = open.fields(forces, true);
  for (std::size_t k = 0; k < forces.size(); ++k) {
    EXPECT_EQ(open.fields({&forces[k], 1}, true).front(), fields[k]);
    const UnitForce unit = strip.condensed().unit_force(sums[k]);
    const VectorXd& r = unit.r;
    EXPECT_NEAR(strip.joined().compliances({&forces[k], 1}).front(), unit.compliance,
                1e-9 * unit.compliance);
    const Displaced dense{&sums[k], strip.condensed().solve_open({}, {&r, 1}, 0).front().d};
    const std::vector<double> u = strip.condensed().fields_of({&dense, 1}).front();
    EXPECT_LT(difference(VectorXd::Map(u.data(), static_cast<Index>(u.size())),
                         VectorXd::Map(fields[k].data(), static_cast<Index>(fields[k].size()))),
              1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Strips, LongCrack,
                         ::testing::Values(Named{"Crack", [] { return strip_with(Kind::crack); }},
                                           Named{"Inclusion",
                                                 [] { return strip_with(Kind::delaminated); }},
                                           Named{"Crossed", crossed_strip}),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(BlockLcp, StopsAtTheLimitAndWhenTold) {
  const Strip strip(strip_with(Kind::crack));
  const Reduced load = strip.reduce(waves[1]);
  LcpOptions options;
  options.max_steps = 1;
  EXPECT_EQ(strip.blocks().solve(load.r, load.magnitude, options, {}).status,
            LcpStatus::step_limit);
  const LcpAnswer told = strip.blocks().solve(load.r, load.magnitude, {}, {},
                                              [](const LcpStep& step) { return step.number < 2; });
  EXPECT_EQ(told.status, LcpStatus::stopped);
  EXPECT_EQ(told.steps, 2);
}

TEST(BlockLcp, ZeroLoadIsClosedAndWeaklyActiveEverywhere) {
  const Strip strip(strip_with(Kind::crack));
  const Index n = strip.dense().size();
  const LcpAnswer answer = strip.blocks().solve(VectorXd::Zero(n), VectorXd::Zero(n), {}, {});
  EXPECT_EQ(answer.status, LcpStatus::solved);
  EXPECT_EQ(answer.weakly_active, n);
  EXPECT_EQ(answer.d.norm() + answer.lambda.norm(), 0);
}

}  // namespace
}  // namespace anticrack::contact
