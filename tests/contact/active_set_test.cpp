// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>

#include "contact/membrane.hpp"
#include "support/errors.hpp"
#include "support/grid_mesh.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::contact {
namespace {

using mesh::Kind;
using ::testing::HasSubstr;

constexpr double rounding = 1e-12;

void expect_exact(const Answer& answer) {
  ASSERT_EQ(answer.status, Status::converged) << answer.reason;
  EXPECT_LT(answer.kkt_relative.equilibrium, rounding);
  EXPECT_EQ(answer.kkt.gap, 0);
  EXPECT_EQ(answer.kkt.sign, 0);
  EXPECT_EQ(answer.kkt.complementarity, 0);
}

template <class Values>
bool same_bits(const Values& a, const Values& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), a.size() * sizeof(typename Values::value_type)) == 0;
}

bool same_answer(const Answer& a, const Answer& b) {
  bool same = a.energy == b.energy && a.closed == b.closed;
  for (std::size_t c = 0; c < a.traces.size(); ++c) {
    same = same && same_bits(a.traces[c].u_minus, b.traces[c].u_minus) &&
           same_bits(a.traces[c].u_plus, b.traces[c].u_plus) &&
           same_bits(a.traces[c].jump, b.traces[c].jump) &&
           same_bits(a.traces[c].pressure, b.traces[c].pressure);
  }
  return same;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, std::abs(a[i] - b[i]));
  }
  return largest;
}

/// Algorithm 2, run until rounding stops it.
void expect_as_uzawa(const Membrane& membrane, const char* force, double tolerance = 1e-9) {
  SCOPED_TRACE(force);
  Recorder recorder;
  const Answer uzawa = membrane.solve(force, tight(), recorder);
  ASSERT_EQ(uzawa.status, Status::converged) << uzawa.reason;
  const Answer exact = membrane.exact(fem::Expression{force});
  expect_exact(exact);
  EXPECT_NEAR(exact.energy, uzawa.energy, tolerance);
  EXPECT_NEAR(exact.contact_length, uzawa.contact_length, 1e-11);
  for (std::size_t j = 0; j < exact.inclusions.size(); ++j) {
    EXPECT_NEAR(exact.inclusions[j].displacement, uzawa.inclusions[j].displacement, tolerance);
    EXPECT_NEAR(exact.inclusions[j].resultant, 0, rounding);
  }
  for (std::size_t c = 0; c < exact.traces.size(); ++c) {
    const Trace &a = exact.traces[c], &b = uzawa.traces[c];
    EXPECT_LT(largest_difference(a.u_minus, b.u_minus), tolerance) << c;
    EXPECT_LT(largest_difference(a.u_plus, b.u_plus), tolerance) << c;
    EXPECT_LT(largest_difference(a.jump, b.jump), tolerance) << c;
    EXPECT_LT(largest_difference(a.pressure, b.pressure), 100 * tolerance) << c;
    EXPECT_EQ(a.contact, b.contact) << c;
  }
}

TEST(ActiveSet, AgreesWithUzawaOnThePapersExamples) {
  const Membrane membrane(testing::structured_mesh({32, 8, {}, {}, {"bar"}}));
  for (const char* force : {"1", "x*y < 0 ? -1 : 1", "y > 0 ? 1 : -1", "x < 0 ? 1 : -1"}) {
    expect_as_uzawa(membrane, force);
  }
}

TEST(ActiveSet, AgreesWithUzawaOnSeveralInclusionsAndCracks) {
  const Membrane membrane(several_inclusions_and_a_crack());
  expect_as_uzawa(membrane, "y > 0 ? 1 + x : -1 + 3*x");
  expect_as_uzawa(membrane, "sin(9*x)*(y > 0 ? 1 : -1)");
}

/// Two subdomains, glue along x = 4; a slit with a corner in the left one, an inclusion with a
/// delaminated end in the right one.
testing::GridMesh slits() {
  testing::GridMesh grid(9, 6, {"left", "right"}, [](int i, int) { return i < 4 ? 0 : 1; });
  grid.mesh.inclusions = {"bar"};
  grid.add({{4, 0}, {4, 6}}, std::vector<Kind>(6, Kind::glue));
  grid.add({{1, 2}, {3, 2}, {3, 4}}, std::vector<Kind>(4, Kind::crack));
  grid.add({{5, 3}, {8, 3}}, {Kind::inclusion, Kind::delaminated, Kind::delaminated}, 0);
  return grid;
}

TEST(ActiveSet, AgreesWithUzawaOnSlitsWithBothSidesInOneSubdomain) {
  const Membrane membrane(slits().mesh);
  for (const char* force : {"1", "y > 2.6 ? 1 : -1", "y > 2.6 ? -1 : 1", "sin(3*x)*cos(2*y)"}) {
    expect_as_uzawa(membrane, force, 1e-8);
  }
}

/// A crack through the point where four glued quarters meet: the two of the upper half hold
/// together, so do the two of the lower, and one contact has two pairs.
TEST(ActiveSet, AgreesWithUzawaOnACrossPointThatSharesOneContact) {
  testing::GridMesh grid(6, 6, {"a", "b", "c", "d"},
                         [](int i, int j) { return (i < 3 ? 0 : 1) + (j < 3 ? 0 : 2); });
  const std::vector<Kind> half = {Kind::glue, Kind::crack, Kind::crack};
  grid.add({{0, 3}, {3, 3}}, half);
  grid.add({{3, 3}, {6, 3}}, {half.rbegin(), half.rend()});
  grid.add({{3, 0}, {3, 3}}, std::vector<Kind>(3, Kind::glue));
  grid.add({{3, 3}, {3, 6}}, std::vector<Kind>(3, Kind::glue));
  const Membrane membrane(grid.mesh);
  ASSERT_EQ(membrane.space.decomposition.skeleton.contacts.size(), 3U);
  for (const char* force : {"y > 3 ? 1 : -1", "y > 3 ? -1 : 1", "(x - 3.2)*(y > 3 ? 1 : -1)"}) {
    expect_as_uzawa(membrane, force, 1e-8);
  }
}

TEST(ActiveSet, SamplesEveryStepWithTheFieldsOfUzawa) {
  const Membrane membrane(testing::structured_mesh({32, 8, {}, {}, {"bar"}}));
  const auto loads = membrane.space.condense(fem::Expression{"x*y < 0 ? -1 : 1"});
  Recorder recorder;
  const Answer answer =
      solve_active_set(membrane.condensed, membrane.mesh, {loads}, {}, false, recorder);
  ASSERT_EQ(recorder.samples.size(), static_cast<std::size_t>(answer.iterations));
  ASSERT_GE(answer.iterations, 2);
  EXPECT_LE(answer.iterations, 10);
  EXPECT_EQ(recorder.samples.front().criterion, 1);
  EXPECT_GT(recorder.samples[1].criterion, 0);
  EXPECT_LT(recorder.samples[1].criterion, 1);
  for (std::size_t k = 0; k < recorder.samples.size(); ++k) {
    EXPECT_EQ(recorder.samples[k].iteration, static_cast<int>(k) + 1);
    EXPECT_LT(recorder.samples[k].kkt.equilibrium, rounding);
  }
  EXPECT_GT(recorder.samples.front().kkt.sign, 0) << "closed, it must pull";
  EXPECT_NEAR(recorder.samples.back().energy, answer.energy, 1e-14);
  EXPECT_EQ(answer.theta, 0);
  EXPECT_TRUE(answer.fields.empty());

  Recorder stops(1);
  EXPECT_EQ(solve_active_set(membrane.condensed, membrane.mesh, {loads}, {}, false, stops).status,
            Status::cancelled);
  ActiveSetOptions one_step;
  one_step.max_steps = 1;
  const Answer limited =
      solve_active_set(membrane.condensed, membrane.mesh, {loads}, one_step, false, recorder);
  EXPECT_EQ(limited.status, Status::not_converged);
  EXPECT_THAT(limited.reason, HasSubstr("max_steps"));
}

TEST(ActiveSet, WarmStartGivesTheSameBitsInFewerSteps) {
  const Membrane membrane(testing::structured_mesh({64, 16, {}, {}, {"bar"}}));
  const fem::Force force = fem::Expression{"x*y < 0 ? -1 : 1"};
  const Answer cold = membrane.exact(force);
  expect_exact(cold);
  const Answer warm = membrane.exact(force, "", cold.closed);
  EXPECT_EQ(warm.iterations, 1);
  EXPECT_LT(warm.iterations, cold.iterations);
  EXPECT_TRUE(same_answer(cold, warm));
  std::vector<char> start(cold.closed.size());
  for (std::size_t i = 0; i < start.size(); ++i) {
    start[i] = i % 3 == 0 ? 1 : 0;
  }
  EXPECT_TRUE(same_answer(cold, membrane.exact(force, "", start)));
  EXPECT_TRUE(same_answer(cold, membrane.exact(force, "", std::vector<char>(start.size(), 0))));
}

TEST(ActiveSet, LoadsOfAnySizeGiveTheSameAnswerScaled) {
  const Membrane membrane(testing::structured_mesh({32, 8, {}, {}, {"bar"}}));
  const auto load = [](double f) { return fem::PerRegion{{{"lower", f}, {"upper", 0.4 * f}}}; };
  const Answer one = membrane.exact(load(1));
  for (const double size : {1e-200, 1e140}) {
    const Answer answer = membrane.exact(load(size));
    ASSERT_EQ(answer.status, Status::converged) << answer.reason;
    EXPECT_EQ(answer.closed, one.closed);
    EXPECT_NEAR(answer.inclusions[0].displacement / size, one.inclusions[0].displacement, rounding);
    for (std::size_t i = 0; i < one.traces[0].jump.size(); ++i) {
      EXPECT_NEAR(answer.traces[0].jump[i] / size, one.traces[0].jump[i], rounding);
      EXPECT_NEAR(answer.traces[0].pressure[i] / size, one.traces[0].pressure[i], 100 * rounding);
    }
    EXPECT_LT(answer.kkt_relative.equilibrium, rounding);
    EXPECT_EQ(answer.kkt_relative.complementarity, 0);
    EXPECT_NEAR(answer.energy / size / size, size < 1 ? 0 : one.energy, rounding);
    EXPECT_TRUE(answer.warnings.empty());
  }
}

/// Traces may still be numbers where their squares are not.
TEST(ActiveSet, LoadWhoseEnergyOverflowsFailsWithItsSize) {
  const Membrane membrane(testing::structured_mesh({32, 8, {}, {}, {"bar"}}));
  for (const double size : {1e160, 1e200}) {
    EXPECT_TRUE(testing::throws([&] { membrane.exact(size); }, errors::Reason::numerical));
    auto loads = membrane.space.condense(0.0);
    const auto& rigid = membrane.space.decomposition.subdomains[1].rigid;
    loads[1].g[std::find(rigid.begin(), rigid.end(), 0) - rigid.begin()] = size;
    Recorder recorder;
    const auto error = testing::error_of(
        [&] { solve_active_set(membrane.condensed, membrane.mesh, {loads}, {}, false, recorder); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->reason(), errors::Reason::numerical);
    EXPECT_THAT(error->what(), HasSubstr(size < 1e170 ? "is 1e+160" : "is 1e+200"));
  }
}

/// Closed under -y the flux goes straight through, also where the inclusion ends in the open.
TEST(ActiveSet, AnInclusionMayLeaveThroughTheNeumannBoundary) {
  for (const Kind kind : {Kind::delaminated, Kind::inclusion}) {
    testing::GridMesh grid(6, 6, {"whole"}, [](int, int) { return 0; });
    grid.release([](double x, double) { return x > 5.5; });
    grid.mesh.inclusions = {"bar"};
    grid.add({{2, 3}, {6, 3}}, std::vector<Kind>(4, kind), 0);
    const Membrane membrane(grid.mesh);
    const Answer answer = membrane.exact(0.0, "-0.7*(y - 3)");
    expect_exact(answer);
    EXPECT_NEAR(answer.energy, 36 * 0.49 / 2, rounding);
    EXPECT_NEAR(answer.inclusions[0].displacement, 0, rounding);
    EXPECT_NEAR(answer.inclusions[0].resultant, 0, rounding);
    if (kind == Kind::delaminated) {
      EXPECT_NEAR(answer.contact_length, 4, rounding);
      EXPECT_NEAR(answer.traces[0].pressure[4], 0.7, 100 * rounding) << "at the boundary";
    }
  }
}

/// A crack from below to above a delaminated inclusion, across it.
testing::GridMesh crack_across_an_inclusion() {
  testing::GridMesh grid(8, 6, {"whole"}, [](int, int) { return 0; });
  grid.mesh.inclusions = {"bar"};
  grid.add({{2, 3}, {6, 3}}, std::vector<Kind>(4, Kind::delaminated), 0);
  grid.add({{4, 1}, {4, 5}}, std::vector<Kind>(4, Kind::crack));
  return grid;
}

TEST(ActiveSet, PressureOfAnInclusionGoesOnWhereACrackCrossesIt) {
  for (const bool turned : {false, true}) {
    testing::GridMesh grid = crack_across_an_inclusion();
    if (turned) {  // the pair that follows from the others is the other one
      std::reverse(grid.mesh.interfaces[1].nodes.begin(), grid.mesh.interfaces[1].nodes.end());
    }
    const Membrane membrane(grid.mesh);
    const Answer pressed = membrane.exact(0.0, "-0.7*(y - 3)");
    expect_exact(pressed);
    const Trace& bar = pressed.traces.at(0);
    for (std::size_t i = 1; i < 4; ++i) {
      EXPECT_NEAR(bar.pressure[i], 0.7, 100 * rounding) << i;
      EXPECT_EQ(bar.contact[i], 1) << i;
    }
    EXPECT_NEAR(pressed.inclusions[0].contact_length, 4, rounding);
    for (const double pressure : pressed.traces.at(1).pressure) {
      EXPECT_NEAR(pressure, 0, 100 * rounding) << "the crack carries nothing";
    }
    for (const char* force : {"y > 3 ? -1 : 1", "(y > 3 ? -1 : 1) + (x > 4 ? 1 : -1)",
                              "(y > 3 ? -1 : 1) + (x > 4 ? -1 : 1)"}) {
      SCOPED_TRACE(force);
      const Answer exact = membrane.exact(fem::Expression{force});
      expect_exact(exact);
      EXPECT_GT(exact.traces[0].pressure[2], 0);
      EXPECT_EQ(exact.traces[0].contact[2], 1);
      Recorder recorder;
      const Answer uzawa = membrane.solve(force, tight(), recorder);
      ASSERT_EQ(uzawa.status, Status::converged) << uzawa.reason;
      EXPECT_NEAR(exact.energy, uzawa.energy, 1e-9);
      for (std::size_t c = 0; c < 2; ++c) {  // multipliers are unique but at the cross point
        for (std::size_t i = 0; i < 5; ++i) {
          EXPECT_NEAR(exact.traces[c].jump[i], uzawa.traces[c].jump[i], 1e-8) << c << i;
          if (i != 2) {
            EXPECT_NEAR(exact.traces[c].pressure[i], uzawa.traces[c].pressure[i], 1e-6) << c << i;
          }
        }
      }
    }
  }
}

TEST(ActiveSet, WithoutLoadEverythingIsZeroAndWeaklyActive) {
  const Membrane membrane(testing::structured_mesh());
  const Answer answer = membrane.exact(0.0);
  expect_exact(answer);
  EXPECT_EQ(answer.iterations, 1);
  EXPECT_EQ(answer.energy, 0);
  EXPECT_EQ(answer.weakly_active, 7);
  EXPECT_EQ(answer.contact_length, 0);
  for (const Field& field : answer.fields) {
    for (const double u : field.u) {
      EXPECT_EQ(u, 0);
    }
  }
}

/// u = x neither opens nor presses: rounding alone must not decide.
TEST(ActiveSet, LoadThatJustTouchesIsWeaklyActive) {
  const mesh::Mesh crack = testing::structured_mesh(
      {32, 8, [](double x) { return std::abs(x) < 0.5 ? Kind::crack : Kind::glue; }, {}, {}});
  const Membrane cracked(crack);
  const Answer answer = cracked.exact(0.0, "x + 3");
  expect_exact(answer);
  EXPECT_EQ(answer.weakly_active, 15);
  EXPECT_LE(answer.iterations, 2);
  Recorder recorder;
  for (const Answer& touching : {answer, cracked.solve(0.0, tight(), recorder, "x + 3")}) {
    EXPECT_EQ(touching.contact_length, 0);
    EXPECT_TRUE(touching.contact_intervals.empty());
    EXPECT_EQ(touching.traces[0].contact, std::vector<std::int32_t>(33, 0));
  }
  for (std::size_t i = 0; i < 33; ++i) {
    EXPECT_EQ(answer.traces[0].jump[i], 0);
    EXPECT_NEAR(answer.traces[0].pressure[i], 0, rounding);
    EXPECT_NEAR(answer.traces[0].u_plus[i], static_cast<double>(i) / 16 + 2, rounding);
  }
}

TEST(ActiveSet, ContactOverTheWholeCrackIsThePatchTest) {
  const Membrane membrane(testing::structured_mesh({32, 8, {}, {}, {"bar"}}));
  const Answer answer = membrane.exact(0.0, "-0.7*y");
  expect_exact(answer);
  EXPECT_NEAR(answer.inclusions[0].displacement, 0, rounding);
  EXPECT_NEAR(answer.energy, 2 * 0.49, rounding);
  EXPECT_EQ(answer.iterations, 1);
  EXPECT_NEAR(answer.contact_length, 1, rounding);
  for (std::size_t i = 1; i < 32; ++i) {  // glue carries the same flux as contact
    const bool contact = i > 8 && i < 24;
    EXPECT_NEAR(answer.traces[0].pressure[i], contact ? 0.7 : 0, 100 * rounding) << i;
    EXPECT_NEAR(answer.traces[0].flux[i], contact ? 0 : 0.7, 100 * rounding) << i;
    EXPECT_NEAR(answer.traces[0].force[i], 0.7 / 16, 100 * rounding) << i;
  }
}

TEST(ActiveSet, EveryNodeMayBeOpen) {
  const Membrane membrane(testing::structured_mesh({32, 8, {}, {}, {"bar"}}));
  const Answer answer = membrane.exact(fem::Expression{"y > 0 ? 1 : -1"});
  expect_exact(answer);
  EXPECT_EQ(answer.contact_length, 0);
  EXPECT_EQ(answer.closed, std::vector<char>(15, 0));
}

TEST(ActiveSet, CrackOfOneNodeAndInclusionOfOneEdge) {
  const auto kind = [](double x) {
    if (x > -0.5 && x < -0.25) return Kind::crack;  // two edges, one node between
    if (x > 0.25 && x < 0.375) return Kind::delaminated;
    return Kind::glue;
  };
  const Membrane membrane(testing::structured_mesh({16, 8, kind, {}, {"bar"}}));
  ASSERT_EQ(membrane.space.decomposition.skeleton.contacts.size(), 1U);
  const Answer open = membrane.exact(fem::Expression{"y > 0 ? 1 : -1"});
  expect_exact(open);
  EXPECT_GT(open.traces[0].jump[5], 0);
  const Answer closed = membrane.exact(fem::Expression{"y > 0 ? -1 : 1"});
  expect_exact(closed);
  EXPECT_GT(closed.traces[0].pressure[5], 0);
  EXPECT_NEAR(closed.contact_length, 0.25, rounding);
  EXPECT_NEAR(closed.inclusions[0].resultant, 0, rounding);
}

TEST(ActiveSet, SolvesWithoutAnyInterface) {
  mesh::Mesh mesh = testing::structured_mesh({8, 4, {}, {}, {}});
  mesh.subdomains = {"whole"};
  mesh.interfaces.clear();
  mesh.subdomain.assign(mesh.subdomain.size(), 0);
  const Answer answer = Membrane(mesh).exact(1.0);
  expect_exact(answer);
  EXPECT_EQ(answer.iterations, 1);
  EXPECT_LT(answer.energy, 0);
}

/// A patch inside that only its rim holds.
testing::GridMesh island(Kind rim) {
  testing::GridMesh grid(6, 6, {"sea", "island"},
                         [](int i, int j) { return i >= 2 && i < 4 && j >= 2 && j < 4 ? 1 : 0; });
  // Counterclockwise: the island is on the plus side.
  grid.add({{2, 2}, {4, 2}, {4, 4}, {2, 4}, {2, 2}}, std::vector<Kind>(8, rim));
  return grid;
}

TEST(ActiveSet, FloatingSubdomainIsHeldByGlue) {
  const Membrane membrane(island(Kind::glue).mesh);
  const Answer answer = membrane.exact(fem::Expression{"x + y"});
  expect_exact(answer);
  EXPECT_EQ(answer.theta_star, 0);
  EXPECT_THAT(ddm::uzawa_obstacle(membrane.space.decomposition, membrane.mesh),
              HasSubstr("island"));
}

/// Glue in one node of the rim is enough; everything else of it may open.
TEST(ActiveSet, FloatingSubdomainHangsOnOneGluedEdge) {
  testing::GridMesh grid = island(Kind::crack);
  grid.mesh.interfaces[0].kind[2] = Kind::glue;
  const Membrane membrane(grid.mesh);
  const Answer pressed = membrane.exact(fem::PerRegion{{{"island", -1.0}}});
  expect_exact(pressed);
  double force = 0;
  const Trace& trace = pressed.traces.at(0);
  for (std::size_t i = 0; i + 1 < trace.force.size(); ++i) force += trace.force[i];
  EXPECT_NEAR(force, 4, 1e-10) << "the weight of the island";
  const Answer pulled = membrane.exact(fem::PerRegion{{{"island", 1.0}}});
  expect_exact(pulled);
  EXPECT_EQ(pulled.contact_length, 0);
  EXPECT_EQ(pulled.closed, std::vector<char>(pulled.closed.size(), 0));
}

TEST(ActiveSet, ResultantIsTheForceOnTheInclusion) {
  const Membrane membrane(slits().mesh);
  auto loads = membrane.space.condense(fem::Expression{"sin(x) - 0.3*y"});
  constexpr double force = 1.75;
  const std::vector<InclusionForce> inclusion_forces = {{{force}, {}}};
  for (std::size_t s = 0; s < loads.size(); ++s) {
    const auto& rigid = membrane.space.decomposition.subdomains[s].rigid;
    const auto held = std::find(rigid.begin(), rigid.end(), 0);
    if (held != rigid.end()) {
      loads[s].g[held - rigid.begin()] += force;
      break;
    }
  }
  Recorder recorder;
  const Answer exact = solve_active_set(membrane.condensed, membrane.mesh,
                                        {loads, inclusion_forces}, {}, false, recorder);
  expect_exact(exact);
  EXPECT_NEAR(exact.inclusions[0].resultant, force, rounding);
  const Answer uzawa = solve_uzawa(membrane.problem, membrane.mesh, {loads, inclusion_forces},
                                   tight(), false, recorder);
  ASSERT_EQ(uzawa.status, Status::converged) << uzawa.reason;
  EXPECT_NEAR(uzawa.inclusions[0].resultant, force, 1e-9);
  EXPECT_NEAR(uzawa.inclusions[0].displacement, exact.inclusions[0].displacement, 1e-9);
}

}  // namespace
}  // namespace anticrack::contact
