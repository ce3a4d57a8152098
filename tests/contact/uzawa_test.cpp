// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/uzawa.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "contact/membrane.hpp"
#include "mesh/refine.hpp"
#include "support/plain_stiffness.hpp"
#include "support/recovered.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::contact {
namespace {

using mesh::Kind;

TEST(Uzawa, MultipliersStayInTheirIntervals) {
  const Membrane membrane(testing::structured_mesh());
  const auto loads = membrane.space.condense(fem::Expression{"x < 0 ? 1 : -1"});
  constexpr double p = 0.1;
  Uzawa uzawa(membrane.problem, Mass::lumped, 1);
  uzawa.start(0, loads, 1.5, p);
  bool at_lower = false, at_upper = false, below_zero = false;
  for (int k = 0; k < 60; ++k) {
    uzawa.step(1);
    for (std::size_t i = 0; i < membrane.space.decomposition.pairs.size(); ++i) {
      const double mu = uzawa.mu(0)[static_cast<Eigen::Index>(i)];
      const bool unilateral = membrane.space.decomposition.pairs[i].unilateral();
      ASSERT_LE(mu, p);
      ASSERT_GE(mu, unilateral ? 0 : -p);
      at_lower |= mu == -p;
      at_upper |= mu == p;
      below_zero |= mu < 0;
    }
  }
  EXPECT_TRUE(at_lower);
  EXPECT_TRUE(at_upper);
  EXPECT_TRUE(below_zero);
}

TEST(Uzawa, FirstIterateIsWithoutMultipliersAndItsCriterionOne) {
  const Membrane membrane(testing::structured_mesh());
  const auto loads = membrane.space.condense(1.0);
  Uzawa uzawa(membrane.problem, Mass::lumped, 1);
  uzawa.start(0, loads, 1.5, 1e5);
  uzawa.step(1);
  EXPECT_EQ(uzawa.iterate(0).number, 1);
  EXPECT_EQ(uzawa.iterate(0).criterion, 1);
  EXPECT_EQ(uzawa.mu(0).norm(), 0);
}

/// The criterion of step 3 from whole fields: |u_k - u_{k-1}|_V^2 / |u_k|_V^2 with the interior.
TEST(Uzawa, CriterionAndEnergyAreThoseOfTheFieldsWithPrescribedValues) {
  const Membrane membrane(testing::structured_mesh());
  const fem::Force force = fem::Expression{"1 + x"};
  const auto loads = membrane.space.condense(force, "x*y + 0.2");
  Uzawa uzawa(membrane.problem, Mass::consistent, 1);
  uzawa.start(0, loads, 1.5, 1e5);
  std::vector<Eigen::VectorXd> previous(2);
  for (int k = 1; k <= 20; ++k) {
    uzawa.step(1);
    const Iterate& iterate = uzawa.iterate(0);
    double criterion = k == 1 ? 1 : 0, energy = 0;
    for (std::size_t s = 0; s < 2; ++s) {
      const ddm::Subdomain& subdomain = membrane.space.decomposition.subdomains[s];
      const Eigen::SparseMatrix<double> stiffness =
          anticrack::testing::plain_stiffness(subdomain.part);
      const Eigen::VectorXd u =
          anticrack::testing::recovered(membrane.space.operators[s], loads[s], uzawa.trace(0, s));
      const double norm = u.dot(stiffness * u);
      energy += norm / 2 - u.dot(fem::load_vector(subdomain.part, force, subdomain.name));
      if (k > 1) {
        const Eigen::VectorXd d = u - previous[s];
        criterion = std::max(criterion, d.dot(stiffness * d) / norm);
      }
      previous[s] = u;
    }
    EXPECT_NEAR(iterate.criterion, criterion, 1e-9 * criterion) << k;
    EXPECT_NEAR(iterate.energy, energy, 1e-12 * std::abs(energy)) << k;
  }
}

/// With lumped mass the fixed point is the nodal contact problem: no admissible neighbour has less
/// energy, and the multipliers are its forces.
TEST(Uzawa, ConvergesToTheConditionsOfContact) {
  const Membrane membrane(testing::structured_mesh({32, 8, {}, {}, {"bar"}}));
  for (const char* force : {"1", "x*y < 0 ? -1 : 1", "y > 0 ? 1 : -1", "y > 0 ? -1 : 1"}) {
    Recorder recorder;
    const Answer answer = membrane.solve(force, tight(), recorder);
    ASSERT_EQ(answer.status, Status::converged) << answer.reason;
    EXPECT_LT(answer.kkt.gap, 1e-12);
    EXPECT_EQ(answer.kkt.sign, 0);
    EXPECT_LT(answer.kkt.complementarity, 1e-12);
    EXPECT_LT(answer.kkt.equilibrium, 1e-13);
    EXPECT_LT(std::abs(answer.inclusions[0].resultant), 1e-13);
  }
}

TEST(Uzawa, SolvesSeveralInclusionsAndCracksTogether) {
  const Membrane membrane(several_inclusions_and_a_crack());
  Recorder recorder;
  const Answer answer = membrane.solve("y > 0 ? 1 + x : -1 + 3*x", tight(), recorder);
  ASSERT_EQ(answer.status, Status::converged) << answer.reason;
  EXPECT_LT(answer.kkt.gap, 1e-11);
  EXPECT_LT(answer.kkt.equilibrium, 1e-13);
  ASSERT_EQ(answer.inclusions.size(), 2U);
  bool crack_open = false;
  const auto geometry = trace_geometry(membrane.space.decomposition, membrane.mesh).at(0);
  const Trace& trace = answer.traces.at(0);
  for (std::size_t i = 0; i < geometry.x.size(); ++i) {
    const double x = geometry.x[i];
    if (geometry.kind[i] == Kind::inclusion || geometry.kind[i] == Kind::delaminated) {
      const InclusionAnswer& held = answer.inclusions[x < 0 ? 0 : 1];
      EXPECT_EQ(trace.u_plus[i], held.displacement) << x;
      if (geometry.kind[i] == Kind::inclusion) {
        EXPECT_NEAR(trace.u_minus[i], held.displacement, 1e-11) << x;
      }
    }
    crack_open |= geometry.kind[i] == Kind::crack && trace.jump[i] > 1e-3;
  }
  EXPECT_TRUE(crack_open);
  for (const InclusionAnswer& held : answer.inclusions) {
    EXPECT_LT(std::abs(held.resultant), 1e-12) << held.name;
    EXPECT_NE(held.displacement, 0);
  }
}

TEST(Uzawa, TurnedInterfaceTurnsTheContact) {
  // With the plus side below, the force turned over gives the same answer upside down.
  mesh::Mesh turned = testing::structured_mesh();
  std::reverse(turned.interfaces[0].nodes.begin(), turned.interfaces[0].nodes.end());
  Recorder recorder;
  const Answer up =
      Membrane(testing::structured_mesh()).solve("x < y + 0.01 ? 1 : -2", tight(), recorder);
  const Answer down = Membrane(turned).solve("x > y - 0.01 ? 1 : -2", tight(), recorder);
  EXPECT_NEAR(up.energy, down.energy, 1e-12);
  EXPECT_NEAR(up.contact_length, down.contact_length, 1e-15);
}

TEST(Uzawa, ObserverSeesEveryIterationAndCanStop) {
  const Membrane membrane(testing::structured_mesh());
  Recorder recorder(7);
  const Answer answer = membrane.solve("1", {}, recorder);
  EXPECT_EQ(answer.status, Status::cancelled);
  EXPECT_EQ(answer.iterations, 7);
  ASSERT_EQ(recorder.samples.size(), 7U);
  for (std::size_t k = 0; k < 7; ++k) {
    EXPECT_EQ(recorder.samples[k].iteration, static_cast<int>(k) + 1);
  }
  EXPECT_TRUE(answer.reason.empty());
}

TEST(Uzawa, WithoutAnyLoadEndsAtOnceWithZero) {
  const Membrane membrane(testing::structured_mesh());
  Recorder recorder;
  const Answer answer = membrane.solve("0", {}, recorder);
  EXPECT_EQ(answer.status, Status::converged);
  EXPECT_EQ(answer.iterations, 2);
  EXPECT_EQ(answer.energy, 0);
}

TEST(Uzawa, IteratesThatOverflowEndNotConverged) {
  const Membrane membrane(testing::structured_mesh());
  Recorder recorder;
  const Answer answer = membrane.solve("1e300", {}, recorder);
  EXPECT_EQ(answer.status, Status::not_converged);
  EXPECT_NE(answer.reason.find("no longer finite"), std::string::npos) << answer.reason;
}

/// Above theta*, but with nothing to oscillate: the open crack of Example 3 must not be misjudged.
TEST(Uzawa, ThetaAboveThetaStarMayConverge) {
  const Membrane membrane(testing::structured_mesh({80, 40, {}, {}, {"bar"}}));
  UzawaOptions options;
  ASSERT_GT(*options.theta, membrane.problem.theta_star(Mass::lumped));
  for (const char* force : {"1", "x*y < 0 ? -1 : 1", "y > 0 ? 1 : -1", "x < 0 ? 1 : -1"}) {
    Recorder recorder;
    EXPECT_EQ(membrane.solve(force, options, recorder).status, Status::converged) << force;
  }
}

TEST(Uzawa, StopsByTheResiduals) {
  const Membrane membrane(testing::structured_mesh({32, 8, {}, {}, {"bar"}}));
  int previous = 0;
  for (const double tolerance : {1e-4, 1e-8, 1e-12}) {
    UzawaOptions options = tight();
    options.epsilon = 1;  // would stop at once
    options.kkt_tolerance = tolerance;
    Recorder recorder;
    const Answer answer = membrane.solve("x*y < 0 ? -1 : 1", options, recorder);
    ASSERT_EQ(answer.status, Status::converged) << answer.reason;
    const KktResiduals& residuals = answer.kkt_relative;
    EXPECT_LE(
        std::max({residuals.equilibrium, residuals.gap, residuals.sign, residuals.complementarity}),
        tolerance);
    EXPECT_GT(residuals.gap, 0);
    EXPECT_GT(answer.iterations, previous);
    previous = answer.iterations;
    EXPECT_EQ(static_cast<int>(recorder.samples.size()), answer.iterations);
  }
  UzawaOptions options = tight();
  options.kkt_tolerance = 1e-12;
  options.max_iterations = 20;
  Recorder recorder;
  const Answer answer = membrane.solve("1", options, recorder);
  EXPECT_EQ(answer.status, Status::not_converged);
  EXPECT_NE(answer.reason.find("kkt_tolerance"), std::string::npos) << answer.reason;
}

/// Stopped, but not at a solution: what a user may set must not make an answer look right.
TEST(Uzawa, StopsWithoutASolutionAreNotConvergedAndSayWhatToChange) {
  const Membrane membrane(testing::structured_mesh({32, 8, {}, {}, {"bar"}}));
  const auto ends = [&](const char* force, const UzawaOptions& options, const char* reason) {
    SCOPED_TRACE(reason);
    Recorder recorder;
    const Answer answer = membrane.solve(force, options, recorder);
    EXPECT_EQ(answer.status, Status::not_converged);
    EXPECT_NE(answer.reason.find(reason), std::string::npos) << answer.reason;
    EXPECT_NE(answer.reason.find("active-set"), std::string::npos) << answer.reason;
    return answer;
  };
  UzawaOptions tiny;
  tiny.theta = 1e-6;
  EXPECT_GT(ends("1", tiny, "set theta to auto").kkt_relative.gap, 0.1);
  UzawaOptions loose = tight();
  loose.epsilon = 1e-5;
  EXPECT_GT(ends("1", loose, "kkt_tolerance").kkt_relative.gap, solution_residual);
  for (const double p : {0.0, 0.05}) {
    UzawaOptions bounded = tight();
    bounded.epsilon = 1e-12;
    bounded.p = p;
    ends("y > 0 ? -1 : 1", bounded, "raise p");
    bounded.kkt_tolerance = 1e-3;
    bounded.max_iterations = 1000;
    ends("y > 0 ? -1 : 1", bounded, "raise p");
  }
  const Membrane graded(
      mesh::grade(testing::structured_mesh({16, 4, {}, {}, {"bar"}}), {.h0 = 0.2}, 100'000));
  for (const std::optional<double> theta : {std::optional(2.0), std::optional<double>()}) {
    UzawaOptions options;
    options.theta = theta;
    Recorder recorder;
    const Answer answer = graded.solve("y > 0 ? 1 : -1", options, recorder);
    EXPECT_EQ(answer.status, Status::not_converged);
    EXPECT_GT(answer.kkt_relative.gap, solution_residual);
    EXPECT_NE(answer.reason.find("active-set"), std::string::npos) << answer.reason;
  }
  UzawaOptions zero;
  zero.p = 0;
  Recorder recorder;
  EXPECT_EQ(membrane.solve("0", zero, recorder).status, Status::converged) << "nothing to carry";
}

TEST(Answer, ListsContactIntervalsAndTracesAlongTheInterface) {
  const Membrane membrane(testing::structured_mesh({32, 8, {}, {}, {"bar"}}));
  Recorder recorder;
  // Pressed together at both tips, pulled apart in the middle.
  const Answer answer = membrane.solve("cos(4*_pi*x)*(y > 0 ? -1 : 1)", tight(), recorder, "0.1");
  ASSERT_EQ(answer.status, Status::converged) << answer.reason;
  const Trace& trace = answer.traces.at(0);
  ASSERT_EQ(trace.u_plus.size(), 33U);
  for (const std::size_t end : {0U, 32U}) {
    EXPECT_EQ(trace.u_plus[end], 0.1);
    EXPECT_EQ(trace.u_minus[end], 0.1);
    EXPECT_EQ(trace.pressure[end], 0);
  }
  double length = 0;
  std::size_t nodes = 0;
  const auto geometry = trace_geometry(membrane.space.decomposition, membrane.mesh).at(0);
  for (std::size_t i = 0; i < 33; ++i) {
    EXPECT_EQ(trace.jump[i], trace.u_plus[i] - trace.u_minus[i]);
    bool inside = false;
    for (const ContactInterval& interval : answer.contact_intervals) {
      inside |= geometry.s[i] >= interval.begin && geometry.s[i] <= interval.end;
    }
    EXPECT_EQ(inside, trace.contact[i] == 1) << geometry.x[i];
    EXPECT_EQ(trace.contact[i] == 1,
              trace.pressure[i] > 0 && geometry.kind[i] == Kind::delaminated);
    nodes += trace.contact[i] == 1 ? 1 : 0;
  }
  for (const ContactInterval& interval : answer.contact_intervals) {
    length += interval.end - interval.begin + 1.0 / 16;
  }
  EXPECT_GT(nodes, 0U);
  EXPECT_NEAR(answer.contact_length, length, answer.contact_length_error);
  EXPECT_LE(answer.contact_length_error, 2.0 / 16);
  EXPECT_EQ(answer.contact_length, answer.inclusions[0].contact_length);
}

}  // namespace
}  // namespace anticrack::contact
