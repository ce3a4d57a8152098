// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "operators/answer_difference.hpp"
#include "operators/mesh_operator.hpp"
#include "support/errors.hpp"
#include "support/silent_observer.hpp"
#include "support/solve.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::operators {
namespace {

using anticrack::testing::error_of;
using anticrack::testing::Silent;
using anticrack::testing::structured_mesh;
using anticrack::testing::throws;
using errors::Reason;
using Outcome = std::variant<PreparedLoad, errors::Error>;
using Operator = std::shared_ptr<const MeshOperator>;

Operator factorised() {
  mesh::Mesh mesh = structured_mesh({32, 8, {}, {}, {"bar"}});
  std::erase_if(mesh.dirichlet, [&](const std::array<std::int32_t, 2>& edge) {
    return mesh.xy[2 * static_cast<std::size_t>(edge[0])] == 1 &&
           mesh.xy[2 * static_cast<std::size_t>(edge[1])] == 1;
  });
  return MeshOperator::factorise(std::make_shared<const mesh::Mesh>(std::move(mesh)), 1, {});
}

std::vector<Outcome> prepare(const MeshOperator& op, const std::vector<fem::Load>& loads,
                             const std::stop_token& stop = {}) {
  std::vector<const fem::Load*> pointers;
  for (const fem::Load& load : loads) {
    pointers.push_back(&load);
  }
  return op.prepare(pointers, stop);
}

/// One of every kind, with and without prescribed values; the fourth is the first again.
fem::Load load_number(int i) {
  fem::Load load;
  const std::string number = std::to_string(i + 1);
  switch (i % 4) {
    case 0:
      load.force = 1.0;
      return load;
    case 1:
      load.force = fem::Expression{"sin(" + number + "*x) - 0.3*y"};
      load.boundary_value = "x/" + number;
      break;
    case 2:
      load.force = fem::PerRegion{{{"upper", 1.0 + i}, {"lower", -1.0}}};
      load.traction = "y*" + number;
      load.point_forces = {{0.3, 0.01 * i, 2.0}};
      break;
    default:
      load.boundary_value = "cos(" + number + "*y)";
      load.inclusion_forces["bar"] = -0.5;
  }
  return load;
}

TEST(PreparedLoad, IsNoneOfATractionThatNoSideTakes) {
  const Operator op = MeshOperator::factorise(
      std::make_shared<const mesh::Mesh>(structured_mesh({32, 8, {}, {}, {"bar"}})), 1, {});
  std::vector<fem::Load> loads(2);
  loads[0].traction = "5";
  loads[1].traction = "0";
  const std::vector<Outcome> outcomes = prepare(*op, loads);
  EXPECT_TRUE(throws([&] { throw std::get<errors::Error>(outcomes[0]); }, Reason::invalid_argument,
                     "traction"));
  EXPECT_TRUE(std::holds_alternative<PreparedLoad>(outcomes[1]));
}

TEST(PreparedLoad, FortyAtOnceAreWhatEachIsAlone) {
  const Operator op = factorised();
  std::vector<fem::Load> loads;
  for (int i = 0; i < 40; ++i) {
    loads.push_back(load_number(i));
  }
  const std::vector<Outcome> prepared = prepare(*op, loads);
  ASSERT_EQ(prepared.size(), loads.size());
  contact::UzawaOptions uzawa;
  uzawa.theta.reset();
  Silent observer;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    SCOPED_TRACE("load " + std::to_string(i));
    const auto* load = std::get_if<PreparedLoad>(&prepared[i]);
    ASSERT_NE(load, nullptr) << std::get<errors::Error>(prepared[i]).what();
    const contact::ActiveSetOptions exact;
    // The same bits: results do not depend on what happened to wait beside a load.
    EXPECT_EQ(difference(op->solve(*load, exact, true, observer),
                         testing::solve(*op, loads[i], exact, true, observer)),
              0);
    const contact::Answer batched = testing::solve(*op, *load, uzawa, true, observer);
    const contact::Answer alone = testing::solve(*op, loads[i], uzawa, true, observer);
    EXPECT_EQ(batched.iterations, alone.iterations);
    EXPECT_EQ(difference(batched, alone), 0);
  }
}

TEST(PreparedLoad, FieldsOfFortyAtOnceAreThoseOfEachAlone) {
  const Operator op = factorised();
  std::vector<fem::Load> loads;
  for (int i = 0; i < 40; ++i) {
    loads.push_back(load_number(i));
  }
  const std::vector<Outcome> prepared = prepare(*op, loads);
  Silent observer;
  std::vector<contact::Answer> answers;
  for (const Outcome& one : prepared) {
    answers.push_back(
        op->solve(std::get<PreparedLoad>(one), contact::ActiveSetOptions(), false, observer));
    EXPECT_TRUE(answers.back().fields.empty());
  }
  std::vector<const PreparedLoad*> of;
  std::vector<contact::Answer*> to;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    of.push_back(&std::get<PreparedLoad>(prepared[i]));
    to.push_back(&answers[i]);
  }
  op->recover_fields(of, to);
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const contact::Answer alone =
        testing::solve(*op, loads[i], contact::ActiveSetOptions(), true, observer);
    ASSERT_EQ(answers[i].fields.size(), 2U);
    EXPECT_EQ(difference(answers[i], alone), 0) << i;
  }
}

TEST(PreparedLoad, WhatIsWrongWithOneIsNobodyElses) {
  const Operator op = factorised();
  std::vector<fem::Load> loads(6);
  loads[0].force = 1.0;
  loads[1].force = fem::PerRegion{{{"attic", 1.0}}};
  loads[2].force = fem::Expression{"x + y"};
  loads[3].force = fem::Expression{"y > 0 ? 1/(x - x) : 1"};  // sound on the first subdomain
  loads[4].boundary_value = "log(x)";
  loads[5].force = -2.0;
  loads[5].inclusion_forces["bar"] = 1.0;
  const std::vector<Outcome> prepared = prepare(*op, loads);
  const auto expect_error = [&](std::size_t i, Reason reason, const std::string& field) {
    const auto* error = std::get_if<errors::Error>(&prepared[i]);
    ASSERT_NE(error, nullptr) << i;
    EXPECT_EQ(error->reason(), reason) << error->what();
    EXPECT_EQ(error->fields().at(0).field, field);
    Silent observer;
    const auto alone = error_of(
        [&] { testing::solve(*op, loads[i], contact::ActiveSetOptions{}, false, observer); });
    ASSERT_TRUE(alone);
    EXPECT_STREQ(error->what(), alone->what());
  };
  expect_error(1, Reason::invalid_argument, "force.per_region[attic]");
  expect_error(3, Reason::expression_invalid, "force.expression");
  expect_error(4, Reason::expression_invalid, "boundary_value");
  Silent observer;
  for (const std::size_t good : {0U, 2U, 5U}) {
    const auto* load = std::get_if<PreparedLoad>(&prepared[good]);
    ASSERT_NE(load, nullptr) << good;
    EXPECT_LT(
        difference(op->solve(*load, contact::ActiveSetOptions{}, true, observer),
                   testing::solve(*op, loads[good], contact::ActiveSetOptions{}, true, observer)),
        1e-13);
  }
  EXPECT_TRUE(prepare(*op, {}).empty());
}

TEST(PreparedLoad, AreCancelledByAStop) {
  const Operator op = factorised();
  std::stop_source stop;
  stop.request_stop();
  for (const Outcome& outcome : prepare(*op, {load_number(0), load_number(1)}, stop.get_token())) {
    const auto* error = std::get_if<errors::Error>(&outcome);
    ASSERT_NE(error, nullptr);
    EXPECT_EQ(error->reason(), Reason::cancelled);
  }
}

TEST(PreparedLoad, KeepsItsMeshAndIsOfNoUseToAnother) {
  Operator op = factorised();
  const std::weak_ptr<const MeshOperator> watched = op;
  std::vector<Outcome> prepared = prepare(*op, {load_number(0)});
  const Operator other = factorised();
  Silent observer;
  EXPECT_TRUE(throws(
      [&] {
        other->solve(std::get<PreparedLoad>(prepared[0]), contact::ActiveSetOptions{}, false,
                     observer);
      },
      Reason::internal));
  op.reset();
  EXPECT_FALSE(watched.expired());
  prepared.clear();
  EXPECT_TRUE(watched.expired());
}

}  // namespace
}  // namespace anticrack::operators
