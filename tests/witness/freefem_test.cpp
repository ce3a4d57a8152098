// SPDX-License-Identifier: GPL-3.0-or-later
//
// Algorithm 2 as published, in FreeFEM++ on our mesh, gives our u_1, u_2 and A.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "contact/observer.hpp"
#include "mesh/refine.hpp"
#include "operators/mesh_operator.hpp"
#include "support/solve.hpp"
#include "support/structured_mesh.hpp"
#include "support/temporary_folder.hpp"
#include "witness/freefem_case.hpp"

namespace anticrack::witness {
namespace {

/// Keeps every criterion.
class History : public contact::Observer {
 public:
  bool on_iteration(const contact::Sample& sample) override {
    criteria.push_back(sample.criterion);
    return true;
  }
  std::vector<double> criteria;
};

/// Finer towards the tips, as the paper's, so that no two edges of the interface are alike by
/// construction.
const std::shared_ptr<const mesh::Mesh>& membrane() {
  static const auto mesh = std::make_shared<const mesh::Mesh>(mesh::grade(
      testing::structured_mesh({16, 8, {}, {}, {"stiffener"}}), {0.15, 0.5, 0.02}, 20'000));
  return mesh;
}

constexpr double theta = 1.7;

struct Case {
  const char* expression;
  std::array<double, 4> quadrants;  ///< the same, as the witness takes it
};

fem::Load load(const char* expression) {
  fem::Load result;
  result.name = "case";
  result.force = fem::Expression{expression};
  return result;
}

class FreeFem : public ::testing::TestWithParam<Case> {};

struct Comparison {
  double largest = 0;     ///< |u|
  double difference = 0;  ///< of u, and of A
};

Comparison compare(const contact::Answer& ours, const Answer& theirs) {
  Comparison result;
  result.difference = std::abs(ours.inclusions.at(0).displacement - theirs.a);
  for (std::size_t s = 0; s < 2; ++s) {
    const contact::Field& field = ours.fields.at(s);
    EXPECT_EQ(field.nodes.size(), theirs.u[s].size());
    for (std::size_t i = 0; i < field.nodes.size(); ++i) {
      const double difference = std::abs(field.u[i] - theirs.u[s].at(field.nodes[i]));
      result.largest = std::max(result.largest, std::abs(field.u[i]));
      result.difference = std::max(result.difference, difference);
    }
  }
  return result;
}

/// What FreeFEM++ makes of `mesh`, with theta below theta*.
Answer witness(const std::string& program, const mesh::Mesh& mesh, int iterations,
               const std::array<double, 4>& quadrants) {
  const testing::TemporaryFolder folder;
  return run(program, folder.path(), mesh, ddm::cut(mesh), {theta, 1e5, iterations, quadrants});
}

TEST_P(FreeFem, AgreesInBothFieldsAndTheInclusion) {
  const auto program = freefem();
  if (!program) {
    GTEST_SKIP() << "FreeFEM++ is not installed (Debian package freefem++)";
  }
  const auto op = operators::MeshOperator::factorise(membrane(), 2, {});
  contact::UzawaOptions options;
  options.theta = theta;
  History history;
  const contact::Answer ours =
      testing::solve(*op, load(GetParam().expression), options, true, history);
  ASSERT_EQ(ours.status, contact::Status::converged) << ours.reason;

  const Answer theirs = witness(*program, *membrane(), ours.iterations, GetParam().quadrants);
  const auto [largest, difference] = compare(ours, theirs);
  std::printf(
      "[ figures  ] %zu triangles, f = %s: %d iterations, criterion %.6e (FreeFEM++ %.6e), A %.12f "
      "(%.12f), |u| %.3f, worst difference %.1e\n",
      membrane()->triangle_count(), GetParam().expression, ours.iterations, ours.criterion,
      theirs.criterion, ours.inclusions.at(0).displacement, theirs.a, largest, difference);
  EXPECT_LT(difference, 1e-8 * largest);
  EXPECT_NEAR(theirs.criterion, ours.criterion, 1e-3 * ours.criterion);
  EXPECT_LT(ours.criterion, options.epsilon);
  EXPECT_GE(history.criteria.at(history.criteria.size() - 2), options.epsilon);
}

/// The paper's stop is 1e-4 away from where the iteration leads; the active set is there.
TEST_P(FreeFem, ConvergesToTheAnswerOfTheActiveSet) {
  const auto program = freefem();
  if (!program) {
    GTEST_SKIP() << "FreeFEM++ is not installed (Debian package freefem++)";
  }
  const auto mesh =
      std::make_shared<const mesh::Mesh>(testing::structured_mesh({16, 8, {}, {}, {"stiffener"}}));
  History history;
  const contact::Answer ours =
      testing::solve(*operators::MeshOperator::factorise(mesh, 2, {}), load(GetParam().expression),
                     contact::ActiveSetOptions{}, true, history);
  ASSERT_EQ(ours.status, contact::Status::converged) << ours.reason;
  constexpr int enough = 300;
  const Answer theirs = witness(*program, *mesh, enough, GetParam().quadrants);
  const auto [largest, difference] = compare(ours, theirs);
  std::printf(
      "[ figures  ] f = %s: %d steps of the active set against %d iterations of FreeFEM++: "
      "worst difference %.1e\n",
      GetParam().expression, ours.iterations, enough, difference);
  EXPECT_LT(difference, 1e-8 * largest);
}

INSTANTIATE_TEST_SUITE_P(Paper, FreeFem,
                         ::testing::Values(Case{"1", {1, 1, 1, 1}},
                                           Case{"x*y > 0 ? 1 : -1", {1, -1, -1, 1}},
                                           Case{"y > 0 ? 1 : -1", {-1, -1, 1, 1}},
                                           Case{"x < 0 ? 1 : -1", {1, -1, 1, -1}}),
                         [](const auto& named) {
                           return "Example" + std::to_string(named.index + 1);
                         });

}  // namespace
}  // namespace anticrack::witness
