// SPDX-License-Identifier: GPL-3.0-or-later
//
// Growth on one mesh against exact solutions, against meshes on which every front is where it is,
// and against differences of energies.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "contact/answer.hpp"
#include "contact/options.hpp"
#include "fem/load.hpp"
#include "growth/crack_in_square.hpp"
#include "growth/on_line.hpp"
#include "operators/grow.hpp"
#include "support/errors.hpp"
#include "support/silent_observer.hpp"
#include "support/structured_mesh.hpp"
#include "tips/measured.hpp"

namespace anticrack::growth {
namespace {

using mesh::Kind;
using operators::Growth;
using operators::MeshOperator;
using operators::PreparedLoad;
using namespace anticrack::testing;

struct Grown {
  std::vector<Row> rows;
  std::vector<Measured> measured;
  std::vector<Event> events;
};

Grown grow(const OnMesh& on, const std::vector<Path>& paths, double step = 0,
           Control control = {}) {
  Growth growth(on.op, on.load, paths);
  Evolution evolution(growth.tracks(), control, step);
  Grown grown;
  while (!evolution.over()) {
    Measured measured = growth.measure(evolution.state());
    if (auto row = evolution.take(measured)) {
      grown.rows.push_back(std::move(*row));
      grown.measured.push_back(std::move(measured));
    }
  }
  grown.events = evolution.events();
  return grown;
}

/// The largest relative error of G1 where both fronts are equally far, less the shift by which
/// these meshes make everything that is open longer: 0.353 of an edge on squares with a diagonal.
double worst_error(const OnMesh& on, int n, double part) {
  Growth growth(on.op, on.load, both_ways);
  double worst = 0;
  for (std::size_t k = 0; k <= static_cast<std::size_t>(n) / 2; k += 4) {
    const Measured measured = growth.measure({{k, k}, {Fate::grows, Fate::grows}});
    const double half = 0.25 + static_cast<double>(k) / n;
    for (const std::optional<double>& G : measured.release)
      worst = std::max(worst, std::abs(*G / (part * exact_rate(half - 0.353 / n)) - 1));
  }
  return worst;
}

TEST(PreviewOfACrack, HasTheRateOfTheExactSolution) {
  constexpr int n = 64;
  for (const bool crooked : {false, true}) {
    const OnMesh on = prepared(
        with_free_sides(square(within(0.75, Kind::crack, Kind::glue), n, crooked)), load_of("y"));
    const double worst = worst_error(on, n, 1);
    std::printf("[ figures  ] crack, %s: G1 %.3f %%\n", crooked ? "crooked" : "regular",
                100 * worst);
    EXPECT_LT(worst, crooked ? 5e-3 : 1e-3);
  }
}

/// The lower half of it: an inclusion held at 0, off which the membrane comes on its minus side.
TEST(PreviewOfADelamination, HasHalfTheRateOfTheCrack) {
  constexpr int n = 64;
  mesh::Mesh mesh = with_free_sides(square(within(0.75, Kind::delaminated, Kind::inclusion), n));
  mesh.motions = {{false, 0.0}};
  EXPECT_LT(worst_error(prepared(mesh, load_of("y")), n, 0.5), 2e-3);
}

/// The longer half releases more: what leads goes on leading, and the other front begins when it
/// has ended.
TEST(PreviewOfACrack, RunsOneWayAtATime) {
  const OnMesh on =
      prepared(with_free_sides(square(within(0.75, Kind::crack, Kind::glue), 64)), load_of("y"));
  const Grown grown = grow(on, both_ways, 4.0 / 64);
  int changes = 0;
  for (std::size_t k = 1; k < grown.rows.size(); ++k)
    changes += grown.rows[k].leader != grown.rows[k - 1].leader ? 1 : 0;
  EXPECT_EQ(changes, 1);
  EXPECT_EQ(grown.rows.front().ties.size(), 1U);
  ASSERT_EQ(grown.events.size(), 2U);
  for (const Event& event : grown.events) EXPECT_EQ(event.fate, Fate::end_of_path);
  const std::vector<Jump> jump = jumps(grown.rows, {});
  ASSERT_EQ(jump.size(), 1U);
  EXPECT_GT(jump[0].not_dissipated, 0);
}

TEST(PreviewUnderContact, IsTheProblemWithEachFrontWhereItIs) {
  const OnMesh on_paths = prepared(square(Bonded::opened, Bonded::n), Bonded::load());
  const Grown grown = grow(on_paths, Bonded::paths(), 4.0 / Bonded::n);
  ASSERT_GE(grown.rows.size(), 3U);
  bool any_contact = false;
  for (std::size_t k = 0; k < grown.rows.size(); ++k) {
    const double front = grown.rows[k].position[0] - 1;
    const KindOf kind = [&](double x) {
      return x > front && x < Bonded::end ? Kind::inclusion : Bonded::opened(x);
    };
    const OnMesh on = prepared(square(kind, Bonded::n), Bonded::load());
    testing::Silent silent;
    const contact::Answer answer =
        on.op->solve(on.load, contact::ActiveSetOptions{}, false, silent);
    const Measured& measured = grown.measured[k];
    EXPECT_NEAR(measured.displacement[0], answer.inclusions[0].displacement,
                1e-10 * std::abs(answer.inclusions[0].displacement));
    EXPECT_NEAR(measured.energy, answer.energy, 1e-10 * std::abs(answer.energy));
    any_contact = any_contact || answer.contact_length > 0;
    // The whole answer is that, too.
    Growth growth(on_paths.op, on_paths.load, Bonded::paths());
    const contact::Answer held = growth.answer({{4 * k}, {Fate::grows}}, {}, silent);
    EXPECT_EQ(held.status, contact::Status::converged) << held.reason;
    EXPECT_NEAR(held.energy, answer.energy, 1e-10 * std::abs(answer.energy));
    EXPECT_NEAR(held.contact_length, answer.contact_length, 1e-9);
    for (std::size_t i = 0; i < answer.traces[0].jump.size(); ++i) {
      EXPECT_NEAR(held.traces[0].u_minus[i], answer.traces[0].u_minus[i], 1e-9);
      EXPECT_EQ(held.traces[0].contact[i], answer.traces[0].contact[i]) << i;
    }
    EXPECT_EQ(measured.contact_length > 0, answer.contact_length > 0);
  }
  EXPECT_TRUE(any_contact);
  EXPECT_EQ(grown.events.back().fate, Fate::snapped);
}

TEST(PreviewUnderContact, HasTheRateOfDifferencesOfEnergies) {
  const Grown grown =
      grow(prepared(square(Bonded::opened, 2 * Bonded::n), Bonded::load()), Bonded::paths());
  ASSERT_GE(grown.rows.size(), 10U);
  for (std::size_t k = 1; k + 1 < grown.rows.size(); ++k) {
    const double by_energy = -(grown.measured[k + 1].energy - grown.measured[k - 1].energy) /
                             (grown.rows[k + 1].position[0] - grown.rows[k - 1].position[0]);
    EXPECT_NEAR(grown.rows[k].G1[0], by_energy, 1e-2 * by_energy) << k;
  }
}

/// The same under random loads that press a part of what is off onto the inclusion, to a part of
/// the largest G: where contact ends at the front G falls to 0 within some edges.
TEST(PreviewUnderContact, HasTheRateOfDifferencesOfEnergiesUnderRandomLoads) {
  const OnMesh on = prepared(square(Bonded::opened, 2 * Bonded::n), Bonded::load());
  std::mt19937 random(11);
  std::uniform_real_distribution<double> one(5, 20), place(-0.45, 0);
  int in_contact = 0;
  double worst = 0, largest = 0;
  for (int trial = 0; trial < 12; ++trial) {
    const fem::Load load =
        load_of("0", "y > 0 ? 2 : x < " + std::to_string(place(random)) + " ? " +
                         std::to_string(one(random)) + " : -" + std::to_string(one(random)));
    const fem::Load* const loads[] = {&load};
    Growth growth(on.op, std::get<PreparedLoad>(on.op->prepare(loads).front()), Bonded::paths());
    for (const std::size_t k : {8U, 20U}) {
      const auto at = [&](std::size_t position) {
        return growth.measure({{position}, {Fate::grows}});
      };
      const Measured before = at(k - 1), here = at(k), after = at(k + 1);
      const double by_energy = (before.energy - after.energy) * Bonded::n;
      EXPECT_GE(by_energy, -1e-12 * std::abs(here.energy));
      if (*here.release[0] == 0) continue;
      worst = std::max(worst, std::abs(*here.release[0] - by_energy));
      largest = std::max(largest, by_energy);
      in_contact += here.contact_length > 0.05 ? 1 : 0;
    }
  }
  std::printf(
      "[ figures  ] random loads: G1 is %.2f %% of the largest off differences of energies, "
      "%d in contact\n",
      100 * worst / largest, in_contact);
  EXPECT_LT(worst, 0.01 * largest);
  EXPECT_GT(in_contact, 4);
}

TEST(PreviewUnderContact, ScalesWithTheLoad) {
  const mesh::Mesh mesh = square(Bonded::opened, Bonded::n);
  constexpr double size = 4;  // a power of two, so that nothing is rounded
  const Grown once = grow(prepared(mesh, Bonded::load()), Bonded::paths());
  const Grown more = grow(prepared(mesh, Bonded::load(size)), Bonded::paths());
  ASSERT_EQ(once.rows.size(), more.rows.size());
  for (std::size_t k = 0; k < once.rows.size(); ++k) {
    EXPECT_EQ(once.rows[k].position, more.rows[k].position);
    EXPECT_NEAR(once.rows[k].load, size * more.rows[k].load, 1e-9 * once.rows[k].load);
    EXPECT_NEAR(once.rows[k].displacement[0], more.rows[k].displacement[0],
                1e-9 * std::abs(once.rows[k].displacement[0]));
    EXPECT_EQ(once.rows[k].contact_length, more.rows[k].contact_length);
  }
}

/// A graded mesh with the front where it is has t_c within 1 %, or a part of it that falls with the
/// edges: at 0 the front is near the end of contact.
TEST(PreviewUnderContact, IsNearAGradedMesh) {
  const Grown grown = grow(prepared(square(Bonded::opened, 4 * Bonded::n), Bonded::load()),
                           Bonded::paths(), 4.0 / Bonded::n);
  for (const Row& row : grown.rows) {
    const double front = row.position[0] - 1;
    if (std::remainder(front, 0.25) != 0) continue;
    const mesh::Mesh base = testing::cut_square([&](double x) {
      return x > front && x < Bonded::end ? Kind::inclusion : Bonded::opened(x);
    });
    const testing::Measured graded = testing::measure(testing::fine(base), Bonded::load());
    const double load = std::sqrt(0.1 / *graded.tip(front).energy_release_rate);
    std::printf("[ figures  ] front at %g: t_c is %.2f %% off a graded mesh\n", front,
                100 * (row.load / load - 1));
    EXPECT_NEAR(row.load, load, (front == 0 ? 0.02 : 0.01) * load) << front;
  }
}

/// The same numbers whatever was solved before.
TEST(PreviewUnderContact, HasNoMemory) {
  const OnMesh on = prepared(square(Bonded::opened, Bonded::n), Bonded::load());
  Growth growth(on.op, on.load, Bonded::paths());
  const State far{{12}, {Fate::grows}}, first{{0}, {Fate::grows}};
  const Measured fresh = growth.measure(first);
  growth.measure(far);
  const Measured again = growth.measure(first);
  EXPECT_EQ(fresh.energy, again.energy);
  EXPECT_EQ(fresh.release, again.release);
  EXPECT_EQ(fresh.displacement, again.displacement);
}

TEST(PreviewOfAClosedFront, DoesNotGrow) {
  // All is pressed onto the inclusion from below.
  const OnMesh on = prepared(square(Bonded::opened, Bonded::n), load_of("0", "y > 0 ? 0 : 10"));
  const Grown grown = grow(on, Bonded::paths());
  ASSERT_EQ(grown.rows.size(), 1U);
  EXPECT_EQ(grown.rows[0].G1[0], 0);
  EXPECT_TRUE(std::isinf(grown.rows[0].load));
}

TEST(Preview, RefusesAFrontThatIsTooNearToSomething) {
  const OnMesh on = prepared(square(Bonded::opened, Bonded::n), Bonded::load());
  const std::vector<Path> near = {on_line(1.7, 1.75, "1")};
  EXPECT_TRUE(testing::throws([&] { Growth(on.op, on.load, near); },
                              errors::Reason::invalid_argument, "paths[0]"));
}

/// Prints what 200 positions on 40,000 triangles, 400 edges along the line, cost; asserts that they
/// are there.
TEST(Preview, FollowsTwoHundredPositions) {
  testing::StructuredOptions options;
  options.columns = 400;
  options.rows = 25;
  options.kind = [](double x) { return Bonded::opened(x); };
  mesh::Mesh mesh = testing::structured_mesh(options);
  for (std::size_t i = 1; i < mesh.xy.size(); i += 2)  // as fine across the line as along it
    mesh.xy[i] = std::copysign(std::expm1(3 * std::abs(mesh.xy[i])) / std::expm1(3.0), mesh.xy[i]);
  ASSERT_EQ(mesh.triangle_count(), 40'000U);
  const OnMesh on = prepared(std::move(mesh), load_of("0", "y > 0 ? 2 : x < -0.45 ? 14 : -10"));
  const std::clock_t begin = std::clock();
  const Grown grown = grow(on, {on_line(0.7, 1.75, "0.1")});
  std::printf("[ figures  ] %zu positions on 40,000 triangles: %.2f s of processor time\n",
              grown.rows.size(), static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  EXPECT_GE(grown.rows.size(), 190U);
}

TEST(Preview, StopsWhenItIsToldTo) {
  const OnMesh on = prepared(square(Bonded::opened, Bonded::n), Bonded::load());
  Growth growth(on.op, on.load, Bonded::paths());
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(testing::throws(
      [&] {
        growth.measure({{0}, {Fate::grows}}, stop.get_token());
      },
      errors::Reason::cancelled));
}

}  // namespace
}  // namespace anticrack::growth
