// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/mesh_operator.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <thread>

#include "errors/errors.hpp"
#include "support/silent_observer.hpp"
#include "support/solve.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::operators {
namespace {

using anticrack::testing::Silent;
using ::testing::HasSubstr;

std::shared_ptr<const mesh::Mesh> shared_membrane(int columns = 32, int rows = 8) {
  return std::make_shared<const mesh::Mesh>(
      testing::structured_mesh({columns, rows, {}, {}, {"bar"}}));
}

contact::UzawaOptions uzawa() {
  contact::UzawaOptions options;
  options.theta.reset();
  return options;
}

contact::Answer solve(const MeshOperator& op, const fem::Load& load, bool fields = false,
                      const contact::SolverOptions& options = uzawa()) {
  Silent observer;
  return testing::solve(op, load, options, fields, observer);
}

template <class Values>
bool same_bits(const Values& a, const Values& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), a.size() * sizeof(typename Values::value_type)) == 0;
}

bool same_bits(const contact::Answer& a, const contact::Answer& b) {
  bool same = a.iterations == b.iterations && a.criterion == b.criterion && a.energy == b.energy &&
              a.inclusions[0].displacement == b.inclusions[0].displacement &&
              a.inclusions[0].resultant == b.inclusions[0].resultant;
  for (std::size_t i = 0; i < a.traces.size(); ++i) {
    same = same && same_bits(a.traces[i].u_minus, b.traces[i].u_minus) &&
           same_bits(a.traces[i].u_plus, b.traces[i].u_plus) &&
           same_bits(a.traces[i].pressure, b.traces[i].pressure);
  }
  for (std::size_t i = 0; i < a.fields.size(); ++i) {
    same = same && same_bits(a.fields[i].u, b.fields[i].u);
  }
  return same;
}

TEST(MeshOperator, SolvesOnManyThreadsWithTheSameBits) {
  const auto op = MeshOperator::factorise(shared_membrane(), 2, {});
  const std::vector<fem::Load> loads = {
      {"one", 1.0, ""},
      {"two", fem::Expression{"x*y < 0 ? -1 : 1"}, ""},
      {"three", fem::PerRegion{{{"upper", 1}, {"lower", -1}}}, "x/5"}};
  const std::vector<contact::SolverOptions> methods = {uzawa(), contact::ActiveSetOptions{}};
  std::vector<contact::Answer> expected;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    for (const contact::SolverOptions& method : methods) {
      expected.push_back(solve(*op, loads[i], true, method));
      ASSERT_EQ(expected.back().status, contact::Status::converged);
    }
  }
  std::atomic<int> different{0};
  {
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < 6; ++t) {
      threads.emplace_back([&, t] {
        for (std::size_t k = 0; k < 4; ++k) {
          const std::size_t i = (t + k) % expected.size();
          const contact::Answer answer = solve(*op, loads[i / 2], true, methods[i % 2]);
          different += same_bits(answer, expected[i]) ? 0 : 1;
        }
      });
    }
  }
  EXPECT_EQ(different, 0);
}

TEST(MeshOperator, FactorisesOnAnyNumberOfThreadsToTheSameBits) {
  const auto mesh = shared_membrane();
  const auto one = MeshOperator::factorise(mesh, 1, {});
  const fem::Load load{"load", fem::Expression{"sin(3*x) - y"}, ""};
  std::vector<std::shared_ptr<const MeshOperator>> others(4);
  {
    std::vector<std::jthread> threads;
    for (auto& other : others) {
      threads.emplace_back([&] { other = MeshOperator::factorise(mesh, 2, {}); });
    }
  }
  for (const auto& other : others) {
    EXPECT_EQ(other->theta_star(), one->theta_star());
    EXPECT_TRUE(same_bits(solve(*other, load), solve(*one, load)));
    const contact::ActiveSetOptions exact;
    EXPECT_TRUE(same_bits(solve(*other, load, true, exact), solve(*one, load, true, exact)));
  }
}

TEST(MeshOperator, FieldsAreOnTheNodesOfEachSubdomain) {
  const auto op = MeshOperator::factorise(shared_membrane(), 2, {});
  const contact::Answer answer = solve(*op, {"load", 1.0, "x + 2*y"}, true);
  ASSERT_EQ(answer.fields.size(), 2U);
  for (std::size_t s = 0; s < 2; ++s) {
    const contact::Field& field = answer.fields[s];
    ASSERT_EQ(field.nodes.size(), 33U * 9);
    ASSERT_EQ(field.u.size(), field.nodes.size());
    for (std::size_t i = 0; i < field.nodes.size(); ++i) {
      const auto node = static_cast<std::size_t>(field.nodes[i]);
      const double x = op->mesh().xy[2 * node], y = op->mesh().xy[2 * node + 1];
      EXPECT_TRUE(s == 0 ? y <= 0 : y >= 0);
      if (std::abs(x) == 1 || std::abs(y) == 1) {
        EXPECT_EQ(field.u[i], x + 2 * y);
      }
    }
  }
  EXPECT_TRUE(solve(*op, {"load", 1.0, ""}).fields.empty());
}

TEST(MeshOperator, TraceGeometryNamesTheConditionOfEachNode) {
  const auto op = MeshOperator::factorise(shared_membrane(), 1, {});
  ASSERT_EQ(op->trace_geometry().size(), 1U);
  const contact::TraceGeometry& geometry = op->trace_geometry()[0];
  ASSERT_EQ(geometry.x.size(), 33U);
  for (std::size_t i = 0; i < 33; ++i) {
    EXPECT_NEAR(geometry.s[i], geometry.x[i] + 1, 1e-15);
    EXPECT_EQ(geometry.y[i], 0);
    const double x = std::abs(geometry.x[i]);
    EXPECT_EQ(geometry.kind[i], x < 0.5    ? mesh::Kind::delaminated
                                : x == 0.5 ? mesh::Kind::inclusion
                                           : mesh::Kind::glue);
  }
}

TEST(MeshOperator, RefusesASubdomainTheMeshDoesNotHave) {
  const auto op = MeshOperator::factorise(shared_membrane(), 1, {});
  try {
    solve(*op, {"load", fem::PerRegion{{{"upper", 1}, {"attic", 2}}}, ""});
    FAIL() << "accepted";
  } catch (const errors::Error& error) {
    EXPECT_EQ(error.reason(), errors::Reason::invalid_argument);
    EXPECT_EQ(error.fields().at(0).field, "force.per_region[attic]");
    EXPECT_THAT(error.what(), HasSubstr("\"lower\", \"upper\""));
  }
}

TEST(MeshOperator, RefusesAForceThatIsNotFiniteAndGoesOnServing) {
  const auto op = MeshOperator::factorise(shared_membrane(), 1, {});
  try {
    solve(*op, {"load", fem::Expression{"1/(y - y)"}, ""});
    FAIL() << "accepted";
  } catch (const errors::Error& error) {
    EXPECT_EQ(error.reason(), errors::Reason::expression_invalid);
    EXPECT_EQ(error.fields().at(0).field, "force.expression");
  }
  try {
    solve(*op, {"load", 1.0, "log(x)"});
    FAIL() << "accepted";
  } catch (const errors::Error& error) {
    EXPECT_EQ(error.fields().at(0).field, "boundary_value");
  }
  EXPECT_EQ(solve(*op, {"load", 1.0, ""}).status, contact::Status::converged);
}

TEST(MeshOperator, StopsBeforeItFactorises) {
  std::stop_source stop;
  stop.request_stop();
  try {
    MeshOperator::factorise(shared_membrane(), 2, stop.get_token());
    FAIL() << "factorised";
  } catch (const errors::Error& error) {
    EXPECT_EQ(error.reason(), errors::Reason::cancelled);
  }
}

TEST(MeshOperator, PassesOnWhatIsWrongWithAMesh) {
  mesh::Mesh floating = testing::structured_mesh();
  floating.dirichlet.clear();
  try {
    MeshOperator::factorise(std::make_shared<const mesh::Mesh>(floating), 2, {});
    FAIL() << "factorised";
  } catch (const errors::Error& error) {
    EXPECT_EQ(error.reason(), errors::Reason::numerical);
  }
}

/// The upper half held by the lower alone.
TEST(MeshOperator, UzawaIsRefusedWhereASubdomainFloatsAndTheActiveSetSolves) {
  mesh::Mesh floating = testing::structured_mesh({16, 4, {}, {}, {"bar"}});
  std::erase_if(floating.dirichlet, [&floating](const std::array<std::int32_t, 2>& edge) {
    return floating.xy[2 * static_cast<std::size_t>(edge[0]) + 1] > 0 ||
           floating.xy[2 * static_cast<std::size_t>(edge[1]) + 1] > 0;
  });
  // Nor may the ends of the interface be held.
  std::erase_if(floating.dirichlet, [&floating](const std::array<std::int32_t, 2>& edge) {
    return floating.xy[2 * static_cast<std::size_t>(edge[0]) + 1] == 0 ||
           floating.xy[2 * static_cast<std::size_t>(edge[1]) + 1] == 0;
  });
  const auto op = MeshOperator::factorise(std::make_shared<const mesh::Mesh>(floating), 1, {});
  EXPECT_EQ(op->theta_star(), 0);
  try {
    solve(*op, {"load", 1.0, ""});
    FAIL() << "solved";
  } catch (const errors::Error& error) {
    EXPECT_EQ(error.reason(), errors::Reason::not_implemented);
    EXPECT_EQ(error.fields().at(0).field, "uzawa");
    EXPECT_THAT(error.what(), HasSubstr("\"upper\""));
    EXPECT_THAT(error.what(), HasSubstr("active-set"));
  }
  const contact::Answer answer = solve(*op, {"load", 1.0, ""}, false, contact::ActiveSetOptions{});
  EXPECT_EQ(answer.status, contact::Status::converged);
  EXPECT_LT(answer.kkt_relative.equilibrium, 1e-12);
}

TEST(MeshOperator, EstimateIsAnUpperBoundOfWhatIsHeld) {
  for (const auto& [columns, rows] :
       {std::pair{4, 1}, {16, 4}, {160, 80}, {400, 2}, {8, 300}, {3200, 2}}) {
    const auto mesh = shared_membrane(columns, rows);
    const std::size_t estimate = estimate_bytes(*mesh);
    const std::size_t held = MeshOperator::factorise(mesh, 2, {})->bytes();
    EXPECT_LE(held, estimate) << columns << " x " << rows;
    EXPECT_LE(estimate, 4 * held + (1 << 16)) << columns << " x " << rows;
  }
}

TEST(MeshOperator, CountsWhatBoundsTakeWhileTheyAreMade) {
  const auto op = MeshOperator::factorise(shared_membrane(160, 80), 1, {});
  const fem::Load load{"load", 1.0, ""};
  const auto prepared = std::get<PreparedLoad>(op->prepare(std::array{&load}).front());
  contact::Answer answer = solve(*op, load, true, contact::ActiveSetOptions{});
  op->estimate(prepared, answer);
  const std::size_t between = op->bytes();
  std::atomic<bool> seen{false};
  std::jthread watcher([&](const std::stop_token& stop) {
    while (!stop.stop_requested() && !seen)
      seen = op->bytes() > between + 100 * op->mesh().triangle_count();
  });
  for (int i = 0; i < 10'000 && !seen; ++i) op->estimate(prepared, answer);
  EXPECT_TRUE(seen);
  EXPECT_EQ(op->bytes(), between);
}

TEST(Blas, IsTheThreadSafeBuild) { EXPECT_NO_THROW(require_threadsafe_blas()); }

}  // namespace
}  // namespace anticrack::operators
