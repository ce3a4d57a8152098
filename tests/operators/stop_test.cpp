// SPDX-License-Identifier: GPL-3.0-or-later
//
// Every stage of a job looks often whether it is still wanted, and ends when it is not.
#include "stop/stop.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <set>
#include <variant>

#include "contact/answer.hpp"
#include "contact/options.hpp"
#include "errors/errors.hpp"
#include "estimate/marking.hpp"
#include "mesh/codec.hpp"
#include "mesh/refine.hpp"
#include "operators/mesh_operator.hpp"
#include "support/grid_mesh.hpp"
#include "support/looks.hpp"
#include "support/silent_observer.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::operators {
namespace {

using testing::Looks;

constexpr std::size_t skeleton = 1 << 20, joined = 0, contacts = 1;  // condensed_up_to

/// Inclusions in a row on one line, in the middle half of each share of it.
mesh::Mesh with_inclusions(int count, int columns) {
  testing::StructuredOptions options;
  options.columns = columns;
  options.rows = columns / 2;
  options.inclusions.clear();
  for (int j = 0; j < count; ++j) options.inclusions.push_back("bar-" + std::to_string(j));
  const auto share = [count](double x) { return (x + 1) / 2 * count; };
  options.kind = [=](double x) {
    const double place = share(x) - std::floor(share(x));
    return std::abs(place - 0.5) < 0.25 ? mesh::Kind::delaminated : mesh::Kind::glue;
  };
  options.inclusion = [=](double x) { return static_cast<std::int32_t>(share(x)); };
  return testing::structured_mesh(options);
}

fem::Load pressure() { return {"pressure", fem::Expression{"1 + x*y"}, ""}; }

PreparedLoad prepare(const MeshOperator& op, const fem::Load& load) {
  const fem::Load* const one[] = {&load};
  std::variant<PreparedLoad, errors::Error> made = std::move(op.prepare(one).front());
  if (const auto* error = std::get_if<errors::Error>(&made)) throw errors::Error(*error);
  return std::get<PreparedLoad>(std::move(made));
}

/// A job up to the stage that is stopped, which `run` is.
struct Stage {
  const char* name;
  std::function<void()> run;
};

/// Runs it once to the end and then stopped at looks all over it.
void expect_stops(const Stage& stage) {
  SCOPED_TRACE(stage.name);
  Looks all;
  {
    const stop::Scope scope(all.asked());
    stage.run();
    all.end();
  }
  std::printf("%s: %zu looks, %.1f ms, at most %.2f ms without (before \"%s\")\n", stage.name,
              all.count(), 1e3 * all.seconds(), 1e3 * all.longest, all.longest_before.c_str());
  ASSERT_GE(all.count(), 3U);
  constexpr std::size_t places = 12;
  std::set<std::size_t> looks{1, 2};
  for (std::size_t i = 1; i <= places; ++i) looks.insert(1 + (all.count() - 2) * i / places);
  for (const std::size_t look : looks) {
    SCOPED_TRACE(look);
    Looks stopped(look);
    const stop::Scope scope(stopped.asked());
    try {
      stage.run();
      ADD_FAILURE() << "went on to its end, after " << stopped.count() << " looks";
    } catch (const errors::Error& error) {
      EXPECT_EQ(error.reason(), errors::Reason::cancelled) << error.what();
    }
    EXPECT_LE(stopped.count(), look + 8);
  }
}

/// All that the server computes for a load on this mesh, stage after stage.
void walk(mesh::Mesh made, std::size_t condensed_up_to) {
  const auto mesh = std::make_shared<const mesh::Mesh>(std::move(made));
  const std::vector<std::uint8_t> twice(mesh->triangle_count(), 2);
  expect_stops({"checking", [&] { mesh::validate(*mesh); }});
  expect_stops({"bisecting", [&] { mesh::refine(*mesh, twice, 10'000'000); }});
  expect_stops({"factorising", [&] { MeshOperator::factorise(mesh, 1, {}, condensed_up_to); }});
  const auto op = MeshOperator::factorise(mesh, 1, {}, condensed_up_to);
  const fem::Load load = pressure();
  testing::Silent observer;
  PreparedLoad prepared = prepare(*op, load);
  expect_stops({"solving and bounding", [&] {
                  // A mesh's own part of the bounds is made once: a new one each time.
                  const auto fresh = MeshOperator::factorise(mesh, 1, {}, condensed_up_to);
                  const auto entry = prepare(*fresh, load);
                  contact::Answer answer = fresh->solve(entry, {}, false, observer);
                  fresh->estimate(entry, answer);
                }});
  contact::Answer answer = op->solve(prepared, {}, false, observer);
  const std::vector<double> indicator = op->estimate(prepared, answer);
  ASSERT_EQ(answer.no_bracket, "");
  ASSERT_TRUE(answer.inclusions.front().displacement_lower);
  expect_stops({"bounding", [&] {
                  contact::Answer again = answer;  // one that was stopped is of no use
                  op->estimate(prepared, again);
                }});
}

TEST(Stops, ManyInclusionsOnASkeleton) { walk(with_inclusions(16, 128), skeleton); }

TEST(Stops, ManyInclusionsOnAJoinedMembrane) { walk(with_inclusions(16, 64), joined); }

TEST(Stops, ManyInclusionsOnCondensedContacts) { walk(with_inclusions(16, 128), contacts); }

TEST(Stops, MoreInclusionsThanAdjointsAreMadeFor) { walk(with_inclusions(32, 128), joined); }

TEST(Stops, EncodingAndDecodingAMesh) {
  const mesh::Mesh mesh = with_inclusions(4, 512);
  mesh::Bytes bytes;
  expect_stops({"encoding", [&] { bytes = mesh::encode(mesh); }});
  expect_stops({"decoding", [&] { mesh::decode_mesh(bytes); }});
}

TEST(Stops, OneOfSeveralThatAreBoundedTogetherLeavesTheOthers) {
  const auto mesh = std::make_shared<const mesh::Mesh>(with_inclusions(4, 32));
  const auto op = MeshOperator::factorise(mesh, 1, {});
  const fem::Load load = pressure();
  testing::Silent observer;
  const auto prepared = prepare(*op, load);
  contact::Answer first = op->solve(prepared, {}, false, observer), second = first, alone = first;
  op->estimate(prepared, alone);
  // Stopped while both are bounded: at each of the looks in turn.
  for (std::size_t look = 1;; look += 1 + look / 8) {
    contact::Answer one = first, other = second;
    std::stop_source stopped;
    MeshOperator::Estimate both[] = {{&prepared, &one, stopped.get_token()},
                                     {&prepared, &other, {}}};
    std::size_t count = 0;
    {
      const stop::Scope scope([&](const stop::Look&) {
        if (++count == look) stopped.request_stop();
        return false;
      });
      op->estimate(both);
    }
    EXPECT_FALSE(both[1].failure);
    EXPECT_EQ(other.inclusions.front().displacement_lower,
              alone.inclusions.front().displacement_lower);
    if (count < look) {
      EXPECT_FALSE(both[0].failure);
      EXPECT_GT(look, 10U);
      break;
    }
    EXPECT_TRUE(both[0].failure) << look;
  }
}

}  // namespace
}  // namespace anticrack::operators
