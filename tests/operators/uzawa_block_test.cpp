// SPDX-License-Identifier: GPL-3.0-or-later
//
// Batched equals alone: whatever else is in the block, and whenever it joins and leaves, a load
// case gets the numbers it gets by itself.
#include <gtest/gtest.h>

#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "contact/observer.hpp"
#include "operators/answer_difference.hpp"
#include "operators/mesh_operator.hpp"
#include "operators/uzawa_block.hpp"
#include "reference/random_membrane.hpp"
#include "support/errors.hpp"
#include "support/solve.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::operators {
namespace {

using anticrack::testing::structured_mesh;
using anticrack::testing::throws;
using contact::Status;
using contact::UzawaOptions;
using Operator = std::shared_ptr<const MeshOperator>;

constexpr double tolerance = 1e-12;

class Recorder : public contact::Observer {
 public:
  explicit Recorder(int stop_after = 1 << 30) : _stop_after(stop_after) {}
  bool on_iteration(const contact::Sample& sample) override {
    samples.push_back(sample);
    return sample.iteration < _stop_after;
  }
  std::vector<contact::Sample> samples;

 private:
  int _stop_after;
};

struct Case {
  fem::Load load;
  UzawaOptions options;
  bool fields = false;
  int stop_after = 1 << 30;
};

struct Solved {
  contact::Answer answer;
  std::vector<contact::Sample> samples;
};

PreparedLoad prepared(const MeshOperator& op, const fem::Load& load) {
  const fem::Load* const one[] = {&load};
  return std::get<PreparedLoad>(std::move(op.prepare(one).front()));
}

Solved alone(const MeshOperator& op, const Case& one) {
  Recorder recorder(one.stop_after);
  contact::Answer answer = testing::solve(op, one.load, one.options, one.fields, recorder);
  return {std::move(answer), std::move(recorder.samples)};
}

/// Where the criterion comes down to rounding an iteration more or less is rounding, too, and moves
/// the answer by no more than that. Elsewhere both stop at the same iteration: the criteria differ
/// by 1e-9 of themselves at most, and fall by more from one iteration to the next; that `epsilon`
/// lies between them does not happen by chance.
constexpr double epsilon_at_rounding = 1e-26;

void expect_same(const Solved& batched, const Solved& expected, const Case& of) {
  const contact::Answer &a = batched.answer, &b = expected.answer;
  EXPECT_EQ(a.status, b.status) << a.reason << " / " << b.reason;
  EXPECT_EQ(a.theta, b.theta);
  EXPECT_EQ(a.theta_star, b.theta_star);
  EXPECT_LE(difference(a, b), tolerance);
  EXPECT_EQ(a.fields.empty(), !of.fields);
  EXPECT_EQ(a.warnings, b.warnings);
  EXPECT_EQ(static_cast<int>(batched.samples.size()), a.iterations);
  if (of.options.epsilon <= epsilon_at_rounding && !of.options.kkt_tolerance) {
    return;
  }
  ASSERT_EQ(a.iterations, b.iterations);
  Gap energy;
  for (std::size_t k = 0; k < batched.samples.size(); ++k) {
    ASSERT_EQ(batched.samples[k].iteration, static_cast<int>(k) + 1);
    energy.add(batched.samples[k].energy, expected.samples[k].energy);
  }
  EXPECT_LE(energy.relative(), tolerance);
}

class Draw {
 public:
  Draw(const MeshOperator& op, unsigned seed) : _op(op), _random(seed) {}

  int pick(int low, int high) { return std::uniform_int_distribution<int>(low, high)(_random); }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(_random);
  }
  bool chance(double probability) { return uniform(0, 1) < probability; }

  fem::Load load() {
    fem::Load load;
    std::vector<double> force(_op.mesh().triangle_count());
    for (double& value : force) {
      value = uniform(-1, 1);
    }
    load.force = fem::Array{"", true, std::make_shared<const std::vector<double>>(force)};
    load.boundary_value = chance(0.5) ? std::to_string(uniform(-1, 1)) + "*x - 0.1*y" : "";
    for (const std::string& inclusion : _op.mesh().inclusions) {
      if (chance(0.3)) {
        load.inclusion_forces[inclusion] = uniform(-1, 1);
      }
    }
    return load;
  }

  /// theta below theta*: above it an iteration may amplify rounding.
  Case load_case(contact::Mass mass) {
    Case drawn;
    drawn.load = load();
    drawn.options.mass = mass;
    drawn.options.theta.reset();
    if (chance(0.5)) {
      drawn.options.theta = uniform(0.3, 0.97) * limit(mass);
    }
    drawn.options.p = chance(0.8) ? 1e5 : uniform(0, 0.2);
    constexpr double epsilons[] = {1e-4, 1e-8, 1e-12, 1e-16, epsilon_at_rounding};
    drawn.options.epsilon = epsilons[pick(0, 4)];
    drawn.options.max_iterations = chance(0.8) ? 100'000 : pick(1, 60);
    if (chance(0.2)) {
      drawn.options.kkt_tolerance = chance(0.5) ? 1e-4 : 1e-7;
      drawn.options.p = 1e5;  // a bound on the multipliers leaves a gap
    }
    drawn.fields = chance(0.5);
    drawn.stop_after = chance(0.2) ? pick(1, 80) : drawn.stop_after;
    return drawn;
  }

 private:
  double limit(contact::Mass mass) {
    Recorder once(1);
    UzawaOptions options;
    options.mass = mass;
    return testing::solve(_op, fem::Load{}, options, false, once).theta_star;
  }

  const MeshOperator& _op;
  std::mt19937 _random;
};

/// Cases join at random iterations, and their answers are taken some time after they ended.
std::vector<Solved> in_block(const Operator& op, const std::vector<Case>& cases, int capacity,
                             Draw& draw) {
  UzawaBlock block(op, cases.front().options.mass, capacity);
  EXPECT_EQ(block.capacity(), capacity);
  std::vector<Recorder> recorders;
  recorders.reserve(cases.size());
  for (const Case& one : cases) {
    recorders.emplace_back(one.stop_after);
  }
  std::vector<Solved> solved(cases.size());
  std::vector<int> at(static_cast<std::size_t>(capacity), -1);  // case in each place
  std::size_t next = 0, done = 0;
  int held = 0;  // places
  const double eagerness = draw.uniform(0.05, 1);
  while (done < cases.size()) {
    while (next < cases.size() && held < capacity && (held == 0 || draw.chance(eagerness))) {
      const Case& one = cases[next];
      const int place =
          block.add(prepared(*op, one.load), one.options, one.fields, recorders[next]);
      EXPECT_GE(place, 0);
      EXPECT_LT(place, capacity);
      EXPECT_EQ(at[static_cast<std::size_t>(place)], -1);
      at[static_cast<std::size_t>(place)] = static_cast<int>(next++);
      ++held;
    }
    const int under_way = block.columns();
    block.step();
    EXPECT_LE(block.columns(), under_way);
    if (block.columns() > 0 && held < capacity && draw.chance(0.5)) {
      continue;
    }
    int last = -1;
    for (UzawaBlock::Ended& ended : block.take_ended()) {
      EXPECT_GT(ended.place, last);
      last = ended.place;
      int& who = at[static_cast<std::size_t>(ended.place)];
      if (who < 0) {
        ADD_FAILURE() << "place " << ended.place << " was free";
        return solved;
      }
      const auto i = static_cast<std::size_t>(std::exchange(who, -1));
      solved[i] = {std::move(ended.answer), std::move(recorders[i].samples)};
      ++done;
      --held;
    }
    EXPECT_EQ(block.columns(), held);
  }
  return solved;
}

void expect_batched_equals_alone(const Operator& op, unsigned seed) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  Draw draw(*op, seed);
  const contact::Mass mass = draw.chance(0.7) ? contact::Mass::lumped : contact::Mass::consistent;
  std::vector<Case> cases;
  for (int i = 0; i < 14; ++i) {
    cases.push_back(draw.load_case(mass));
  }
  const std::vector<Solved> solved = in_block(op, cases, draw.pick(1, 9), draw);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    expect_same(solved[i], alone(*op, cases[i]), cases[i]);
  }
}

Operator factorised_mesh(mesh::Mesh mesh) {
  return MeshOperator::factorise(std::make_shared<const mesh::Mesh>(std::move(mesh)), 1, {});
}

class BatchedEqualsAlone : public ::testing::TestWithParam<unsigned> {};

TEST_P(BatchedEqualsAlone, OnAStructuredMesh) {
  expect_batched_equals_alone(factorised_mesh(structured_mesh({32, 8, {}, {}, {"bar"}})),
                              GetParam());
}

TEST_P(BatchedEqualsAlone, OnRandomMembranes) {
  int compared = 0;
  for (unsigned mesh_seed = GetParam(); compared < 3; mesh_seed += 1000) {
    Operator op;
    try {
      op = factorised_mesh(reference::RandomMembrane(mesh_seed).mesh());
    } catch (const errors::Error&) {
      continue;  // cracks that depend on each other, parts that only contact holds
    }
    if (op->uzawa_obstacle().empty()) {
      expect_batched_equals_alone(op, mesh_seed);
      ++compared;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, BatchedEqualsAlone, ::testing::Values(11U, 12U, 13U, 14U, 15U));

Case of(const std::string& force) {
  Case one;
  one.load.force = fem::Expression{force};
  one.options.theta.reset();
  return one;
}

/// What one column does, the others do not feel.
TEST(UzawaBlock, KeepsColumnsThatBreakDownToThemselves) {
  const Operator op = factorised_mesh(structured_mesh({80, 40, {}, {}, {"bar"}}));
  std::vector<Case> cases = {of("1"), of("x*y < 0 ? -1 : 1"), of("1e300"), of("x < 0 ? 1 : -1"),
                             of("sin(5*x) + y")};
  cases[1].options.theta = 3 * op->theta_star();  // oscillates
  cases[4].stop_after = 17;
  Draw draw(*op, 1);
  const std::vector<Solved> solved = in_block(op, cases, 5, draw);
  for (const std::size_t good : {0U, 3U}) {
    EXPECT_EQ(solved[good].answer.status, Status::converged);
    expect_same(solved[good], alone(*op, cases[good]), cases[good]);
  }
  EXPECT_EQ(solved[1].answer.status, Status::not_converged);
  EXPECT_NE(solved[1].answer.reason.find("oscillates"), std::string::npos)
      << solved[1].answer.reason;
  EXPECT_EQ(solved[2].answer.status, Status::not_converged);
  EXPECT_NE(solved[2].answer.reason.find("no longer finite"), std::string::npos)
      << solved[2].answer.reason;
  EXPECT_EQ(solved[4].answer.status, Status::cancelled);
  EXPECT_EQ(solved[4].answer.iterations, 17);
}

TEST(UzawaBlock, AColumnDoesNotRememberWhoWasInItsPlace) {
  const Operator op = factorised_mesh(structured_mesh({32, 8, {}, {}, {"bar"}}));
  const Case one = of("x*y < 0 ? -1 : 1");
  UzawaBlock used(op, contact::Mass::lumped, 1), fresh(op, contact::Mass::lumped, 1);
  const auto run = [&](UzawaBlock& block, const Case& solved) {
    Recorder recorder;
    EXPECT_EQ(block.add(prepared(*op, solved.load), solved.options, true, recorder), 0);
    while (block.columns() > 0) {
      block.step();
    }
    return std::move(block.take_ended().at(0).answer);
  };
  EXPECT_EQ(run(used, of("1e300")).status, Status::not_converged);  // leaves no finite number
  run(used, of("x"));
  EXPECT_EQ(difference(run(used, one), run(fresh, one)), 0);
  EXPECT_TRUE(used.take_ended().empty());
  used.step();  // of nothing
}

TEST(UzawaBlock, RefusesWhatCannotBeAColumn) {
  const Operator op = factorised_mesh(structured_mesh());
  const Operator other = factorised_mesh(structured_mesh());
  const Case one = of("1");
  UzawaBlock block(op, contact::Mass::lumped, 1);
  Recorder recorder;
  UzawaOptions consistent = one.options;
  consistent.mass = contact::Mass::consistent;
  EXPECT_TRUE(throws([&] { block.add(prepared(*op, one.load), consistent, false, recorder); },
                     errors::Reason::internal));
  EXPECT_TRUE(throws([&] { block.add(prepared(*other, one.load), one.options, false, recorder); },
                     errors::Reason::internal));
  EXPECT_EQ(block.columns(), 0);
  block.add(prepared(*op, one.load), one.options, false, recorder);
  EXPECT_TRUE(throws([&] { block.add(prepared(*op, one.load), one.options, false, recorder); },
                     errors::Reason::internal));
  EXPECT_EQ(block.columns(), 1);
}

/// The upper half held by the lower alone.
TEST(UzawaBlock, RefusesAMeshWithAnObstacle) {
  mesh::Mesh floating = structured_mesh({16, 4, {}, {}, {"bar"}});
  std::erase_if(floating.dirichlet, [&floating](const std::array<std::int32_t, 2>& edge) {
    return floating.xy[2 * static_cast<std::size_t>(edge[0]) + 1] >= 0 ||
           floating.xy[2 * static_cast<std::size_t>(edge[1]) + 1] >= 0;
  });
  const Operator op = factorised_mesh(floating);
  EXPECT_NE(op->uzawa_obstacle().find("\"upper\""), std::string::npos) << op->uzawa_obstacle();
  EXPECT_TRUE(throws([&] { UzawaBlock(op, contact::Mass::lumped, 4); },
                     errors::Reason::not_implemented, "uzawa"));
  EXPECT_TRUE(factorised_mesh(structured_mesh())->uzawa_obstacle().empty());
}

}  // namespace
}  // namespace anticrack::operators
