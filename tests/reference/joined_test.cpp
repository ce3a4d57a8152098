// SPDX-License-Identifier: GPL-3.0-or-later
//
// The joined membrane against dense matrices on membranes with many inclusions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "errors/errors.hpp"
#include "operators/mesh_operator.hpp"
#include "reference/random_fibres.hpp"
#include "reference/random_membrane.hpp"
#include "support/multipliers.hpp"
#include "support/random_seed.hpp"
#include "support/silent_observer.hpp"
#include "support/solve.hpp"

namespace anticrack::reference {
namespace {

using operators::MeshOperator;

/// Largest difference, and the largest number.
struct Distance {
  double difference = 0, size = 0;

  void add(double a, double b) {
    difference = std::max(difference, std::isfinite(a + b) ? std::abs(a - b) : INFINITY);
    size = std::max({size, std::abs(a), std::abs(b)});
  }
  void add(const std::vector<double>& a, const std::vector<double>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) add(a[i], b[i]);
  }
  double relative() const { return difference == 0 ? 0 : difference / size; }
};

/// Of two answers, each relative to the largest number of its kind.
struct Distances {
  Distance u, pressure, slope, force, moment, energy, length;

  Distances(const contact::Answer& a, const contact::Answer& b) {
    for (std::size_t s = 0; s < a.fields.size(); ++s) u.add(a.fields[s].u, b.fields[s].u);
    for (std::size_t c = 0; c < a.traces.size(); ++c) {
      u.add(a.traces[c].u_minus, b.traces[c].u_minus);
      u.add(a.traces[c].u_plus, b.traces[c].u_plus);
      u.add(a.traces[c].jump, b.traces[c].jump);
      pressure.add(testing::multipliers(a.traces[c]), testing::multipliers(b.traces[c]));
    }
    for (std::size_t j = 0; j < a.inclusions.size(); ++j) {
      const contact::InclusionAnswer &one = a.inclusions[j], &other = b.inclusions[j];
      u.add(one.displacement, other.displacement);
      slope.add(one.slope_x, other.slope_x);
      slope.add(one.slope_y, other.slope_y);
      force.add(one.resultant, other.resultant);
      moment.add(one.moment_x, other.moment_x);
      moment.add(one.moment_y, other.moment_y);
    }
    energy.add(a.energy, b.energy);
    energy.size = std::max(energy.size, u.size);  // what g_D and the forces give may cancel
    length.add(a.contact_length, b.contact_length);
  }
};

struct JoinedTally {
  int compared = 0, refused = 0, unsolvable = 0, inclusions = 0, open = 0, closed = 0;
  int steps = 0;
  double u = 0, pressure = 0, slope = 0, force = 0, moment = 0, energy = 0, length = 0, kkt = 0;

  void add(const Distances& of) {
    u = std::max(u, of.u.relative());
    pressure = std::max(pressure, of.pressure.relative());
    slope = std::max(slope, of.slope.relative());
    force = std::max(force, of.force.relative());
    moment = std::max(moment, of.moment.relative());
    energy = std::max(energy, of.energy.relative());
    length = std::max(length, of.length.relative());
  }
};

fem::Load random_load(RandomFibres& membrane) {
  const mesh::Mesh& mesh = membrane.mesh();
  std::vector<double> force;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) force.push_back(membrane.uniform(-1, 1));
  fem::Load load;
  load.name = "random";
  load.force = fem::Array{"", true, std::make_shared<const std::vector<double>>(std::move(force))};
  char boundary[80];
  std::snprintf(boundary, sizeof boundary, "%.17g*x - %.17g*y", membrane.uniform(-1, 1),
                membrane.uniform(-1, 1));
  load.boundary_value = boundary;
  const std::vector<char> tilts = tilting(mesh);
  for (std::size_t j = 0; j < mesh.inclusions.size(); ++j) {
    load.inclusion_forces[mesh.inclusions[j]] = membrane.uniform(-3, 3);
    if (tilts[j] != 0)
      load.inclusion_moments[mesh.inclusions[j]] = {membrane.uniform(-3, 3),
                                                    membrane.uniform(-3, 3)};
  }
  return load;
}

void compare_paths(unsigned seed, JoinedTally& tally) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  RandomFibres membrane(seed);
  const auto mesh = std::make_shared<const mesh::Mesh>(membrane.mesh());
  std::shared_ptr<const MeshOperator> dense, joined;
  try {
    dense = MeshOperator::factorise(mesh, 1, {});
  } catch (const errors::Error& error) {
    ++tally.refused;
    EXPECT_THROW(MeshOperator::factorise(mesh, 1, {}, seed % 2), errors::Error) << error.what();
    return;
  }
  joined = MeshOperator::factorise(mesh, 1, {}, seed % 2);  // by blocks, or with S^
  const fem::Load load = random_load(membrane);
  anticrack::testing::Silent silent;
  const auto solved = [&](const MeshOperator& op) {
    return anticrack::testing::solve(op, load, contact::ActiveSetOptions{}, true, silent);
  };
  contact::Answer wanted;
  try {
    wanted = solved(*dense);
  } catch (const errors::Error& error) {
    ++tally.unsolvable;  // what holds a body does not agree
    EXPECT_EQ(error.reason(), errors::Reason::invalid_argument) << error.what();
    EXPECT_THROW(solved(*joined), errors::Error);
    return;
  }
  const contact::Answer answer = solved(*joined);
  ASSERT_EQ(wanted.status, contact::Status::converged) << wanted.reason;
  ASSERT_EQ(answer.status, contact::Status::converged) << answer.reason;
  const Distances distances(answer, wanted);
  const contact::KktResiduals& kkt = answer.kkt_relative;
  tally.add(distances);
  tally.kkt = std::max({tally.kkt, kkt.equilibrium, kkt.gap, kkt.sign, kkt.complementarity});
  ++tally.compared;
  tally.inclusions += static_cast<int>(mesh->inclusions.size());
  tally.steps = std::max(tally.steps, answer.iterations);
  for (const char closed : wanted.closed) ++(closed != 0 ? tally.closed : tally.open);
  EXPECT_EQ(answer.closed, wanted.closed);
  for (const Distance& one : {distances.u, distances.pressure, distances.slope, distances.force,
                              distances.moment, distances.energy, distances.length})
    EXPECT_LT(one.relative(), 1e-10);
  EXPECT_LT(std::max({kkt.equilibrium, kkt.gap, kkt.sign, kkt.complementarity}), 1e-10);
}

TEST(JoinedMembrane, HasTheAnswersOfDenseMatricesOnManyInclusions) {
  const unsigned seed = testing::random_seed();
  constexpr unsigned tries = 300;
  std::printf("[ seed     ] %u to %u\n", seed, seed + tries - 1);
  JoinedTally tally;
  for (unsigned k = 0; k < tries && !HasFailure(); ++k) compare_paths(seed + k, tally);
  std::printf(
      "[ figures  ] %d compared with %d inclusions, %d refused, %d without a solution; contacts: "
      "%d open, %d closed; at most %d steps; worst relative difference: u and A %.1e, pressure "
      "%.1e, B %.1e, resultant %.1e, moment %.1e, energy %.1e, length %.1e; kkt %.1e\n",
      tally.compared, tally.inclusions, tally.refused, tally.unsolvable, tally.open, tally.closed,
      tally.steps, tally.u, tally.pressure, tally.slope, tally.force, tally.moment, tally.energy,
      tally.length, tally.kkt);
  EXPECT_GT(tally.compared, static_cast<int>(tries) / 3);
  EXPECT_GT(tally.open, 100);
  EXPECT_GT(tally.closed, 100);
}

}  // namespace
}  // namespace anticrack::reference
