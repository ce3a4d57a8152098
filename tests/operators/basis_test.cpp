// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bases of sweeps as MeshOperator keeps them.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "operators/basis_cache.hpp"
#include "operators/sweep_support.hpp"
#include "support/errors.hpp"

namespace anticrack::operators {
namespace {

using anticrack::testing::throws;
using contact::SweepColumns;
using errors::Reason;

TEST(LoadBasis, IsKeptByTheContentOfItsLoads) {
  const Operator op = factorised();
  const std::size_t before = op->bytes();
  const auto first = basis_of(*op, three_loads());
  const std::size_t with_one = op->bytes();
  EXPECT_EQ(first->size(), 3U);
  EXPECT_GE(with_one, before + first->bytes());
  std::vector<fem::Load> renamed = three_loads();
  renamed[0].name = "another name";
  basis_of(*op, renamed);
  EXPECT_EQ(op->bytes(), with_one);
  renamed[0].force = 1.5;
  basis_of(*op, renamed);
  EXPECT_GT(op->bytes(), with_one);
  for (int i = 0; i < 20; ++i) {
    renamed[0].force = 2.0 + i;
    basis_of(*op, renamed);
  }
  // Eight are kept. A basis somebody holds counts and is good for as long as that, and its mesh
  // with it.
  EXPECT_LE(op->bytes(), before + 9 * (with_one - before));
  SweepColumns rows = columns(*op, 1);
  std::vector<char> start;
  EXPECT_TRUE(op->sweep(*first, std::vector<double>{1, 1, 1}, {}, rows, start));
}

TEST(LoadBasis, SaysWhichLoadIsWrong) {
  const Operator op = factorised();
  std::vector<fem::Load> loads = three_loads();
  loads[1].force = fem::PerRegion{{{"attic", 1.0}}};
  EXPECT_TRUE(throws([&] { basis_of(*op, loads); }, Reason::invalid_argument,
                     "load_cases[1].force.per_region[attic]"));
  EXPECT_TRUE(throws([&] { basis_of(*op, {}); }, Reason::invalid_argument, "load_cases"));
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(throws([&] { basis_of(*op, three_loads(), stop.get_token()); }, Reason::cancelled));
  EXPECT_EQ(basis_of(*op, three_loads())->size(), 3U);
}

TEST(LoadKey, TellsLoadsApartByAllButTheirNames) {
  const auto key = [](const fem::Load& load) {
    const fem::Load* const one[] = {&load};
    return key_of(one);
  };
  std::vector<fem::Load> loads(13);
  loads[1].force = 1.0;
  loads[2].force = fem::Expression{"1"};
  loads[3].force = fem::PerRegion{{{"upper", 1.0}}};
  loads[4].boundary_value = "1";
  loads[5].traction = "1";
  loads[6].point_forces = {{0.1, 0.2, 1}};
  loads[7].point_forces = {{0.1, 0.2, 2}};
  loads[8].inclusion_forces["bar"] = 1;
  loads[9].force = fem::Array{"hash", true, nullptr};
  loads[10].force = fem::Array{"hash", false, nullptr};
  loads[11].inclusion_moments["bar"] = {1, 0};
  loads[12].inclusion_moments["bar"] = {0, 1};
  for (std::size_t i = 0; i < loads.size(); ++i) {
    fem::Load renamed = loads[i];
    renamed.name = "name";
    EXPECT_EQ(key(renamed), key(loads[i]));
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_NE(key(loads[i]), key(loads[j])) << i << " " << j;
    }
  }
  const fem::Load* const pair[] = {&loads[0], &loads[1]};
  const fem::Load* const swapped[] = {&loads[1], &loads[0]};
  EXPECT_NE(key_of(pair), key_of(swapped));
  fem::Load unnamed;
  unnamed.force = fem::Array{"", true, std::make_shared<const std::vector<double>>(3, 1.0)};
  EXPECT_FALSE(key(unnamed).has_value());
}

BasisCache::Basis basis_of_size(Eigen::Index numbers) {
  CondensedBasis basis;
  basis.reduced.r.setZero(numbers, 1);
  return std::make_shared<const CondensedBasis>(std::move(basis));
}

TEST(BasisCache, KeepsTheEightUsedLast) {
  BasisCache cache;
  int made = 0;
  const auto ask = [&](int i) {
    return cache.get(std::to_string(i), {}, [&] {
      ++made;
      return basis_of_size(10);
    });
  };
  for (int i = 0; i < 8; ++i) {
    ask(i);
  }
  ask(0);
  EXPECT_EQ(made, 8);
  ask(8);  // in the place of 1
  ask(0);
  EXPECT_EQ(made, 9);
  ask(1);
  EXPECT_EQ(made, 10);
  EXPECT_LE(cache.bytes(), 8 * (basis_of_size(10)->bytes() + 1));
}

TEST(BasisCache, KeepsNoMoreThanItsBytes) {
  BasisCache cache;
  int made = 0;
  const auto ask = [&](const char* key, std::size_t bytes) {
    cache.get(key, {}, [&] {
      ++made;
      return basis_of_size(static_cast<Eigen::Index>(bytes / sizeof(double)));
    });
  };
  ask("large", BasisCache::most_bytes + 8);
  EXPECT_EQ(cache.bytes(), 0U);
  ask("half", BasisCache::most_bytes / 2);
  ask("other half", BasisCache::most_bytes / 2);  // with what they are wrapped in: too much
  EXPECT_LE(cache.bytes(), BasisCache::most_bytes);
  EXPECT_EQ(made, 3);
  ask("other half", 8);
  EXPECT_EQ(made, 3);
  ask("half", 8);
  EXPECT_EQ(made, 4);
}

/// The maker waits inside until the others have been let in; whether they wait or come later, there
/// is one maker.
TEST(BasisCache, OfManyAtOnceOneMakes) {
  BasisCache cache;
  std::atomic<int> made{0}, asking{0};
  std::vector<BasisCache::Basis> found(6);
  {
    std::vector<std::jthread> threads;
    for (BasisCache::Basis& mine : found) {
      threads.emplace_back([&] {
        ++asking;
        mine = cache.get("key", {}, [&] {
          ++made;
          while (asking < static_cast<int>(found.size())) {
            std::this_thread::yield();
          }
          return basis_of_size(4);
        });
      });
    }
  }
  EXPECT_EQ(made, 1);
  for (const BasisCache::Basis& mine : found) {
    EXPECT_EQ(mine, found[0]);
  }
}

TEST(BasisCache, AStoppedMakerIsFollowedByTheNext) {
  BasisCache cache;
  const auto fail = [](Reason reason) {
    return [reason]() -> BasisCache::Basis { throw errors::Error(reason, "made to fail"); };
  };
  EXPECT_TRUE(throws([&] { cache.get("key", {}, fail(Reason::cancelled)); }, Reason::cancelled));
  EXPECT_TRUE(throws([&] { cache.get("key", {}, fail(Reason::invalid_argument)); },
                     Reason::invalid_argument));
  std::atomic<bool> inside{false}, leave{false};
  std::jthread maker([&] {
    EXPECT_TRUE(throws(
        [&] {
          cache.get("key", {}, [&]() -> BasisCache::Basis {
            inside = true;
            while (!leave) {
              std::this_thread::yield();
            }
            throw errors::Error(Reason::cancelled, "stopped");
          });
        },
        Reason::cancelled));
  });
  while (!inside) {
    std::this_thread::yield();
  }
  // One who waits can be stopped.
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(throws([&] { cache.get("key", stop.get_token(), fail(Reason::internal)); },
                     Reason::cancelled));
  int made = 0;
  std::jthread next([&] {
    cache.get("key", {}, [&] {
      ++made;
      return basis_of_size(4);
    });
  });
  leave = true;
  next.join();
  EXPECT_EQ(made, 1);
}

}  // namespace
}  // namespace anticrack::operators
