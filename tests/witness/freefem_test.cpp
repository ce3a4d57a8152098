// SPDX-License-Identifier: GPL-3.0-or-later
//
// Algorithm 2 as published, in FreeFEM++ on our mesh, gives our u_1, u_2 and A.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "mesh/refine.hpp"
#include "operators/mesh_operator.hpp"
#include "support/structured_mesh.hpp"
#include "support/temporary_folder.hpp"
#include "witness/freefem_case.hpp"

namespace anticrack::witness {
namespace {

/// Keeps the criterion of the iteration before the last.
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

struct Case {
  const char* expression;
  std::array<double, 4> quadrants;  ///< the same, as the witness takes it
};

class FreeFem : public ::testing::TestWithParam<Case> {};

TEST_P(FreeFem, AgreesInBothFieldsAndTheInclusion) {
  const auto program = freefem();
  if (!program) {
    GTEST_SKIP() << "FreeFEM++ is not installed (Debian package freefem++)";
  }
  const auto op = operators::MeshOperator::factorise(membrane(), 2, {});
  contact::UzawaOptions options;
  options.theta = 1.7;
  History history;
  const contact::Answer ours =
      op->solve({"case", fem::Expression{GetParam().expression}}, options, true, history);
  ASSERT_EQ(ours.status, contact::Status::converged) << ours.reason;

  const testing::TemporaryFolder folder;
  const Answer theirs = run(*program, folder.path(), *membrane(), ddm::cut(*membrane()),
                            {1.7, options.p, ours.iterations, GetParam().quadrants});
  double scale = 0;
  double difference = 0;
  for (std::size_t s = 0; s < 2; ++s) {
    const contact::Field& field = ours.fields.at(s);
    ASSERT_EQ(field.nodes.size(), theirs.u[s].size());
    for (std::size_t i = 0; i < field.nodes.size(); ++i) {
      scale = std::max(scale, std::abs(field.u[i]));
      difference = std::max(difference, std::abs(field.u[i] - theirs.u[s].at(field.nodes[i])));
    }
  }
  const double a = ours.inclusions.at(0).displacement;
  std::printf(
      "[ figures  ] %zu triangles, f = %s: %d iterations, criterion %.3e (FreeFEM++ %.3e), "
      "A %.12f (%.12f), |u| %.3f, worst difference %.1e\n",
      membrane()->triangle_count(), GetParam().expression, ours.iterations, ours.criterion,
      theirs.criterion, a, theirs.a, scale, difference);
  EXPECT_LT(difference, 1e-8 * scale);
  EXPECT_NEAR(a, theirs.a, 1e-8 * scale);
  EXPECT_LT(theirs.criterion, options.epsilon * (1 + 1e-6));
  EXPECT_NEAR(theirs.criterion, ours.criterion, 1e-3 * ours.criterion);
  EXPECT_GE(history.criteria.at(history.criteria.size() - 2), options.epsilon);
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
