// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "support/backend.hpp"
#include "support/errors.hpp"
#include "support/eventually.hpp"

namespace anticrack::meshes {
namespace {

using anticrack::testing::Backend;
using anticrack::testing::BackendOptions;
using anticrack::testing::eventually;
using errors::Reason;
using records::MeshState;

constexpr std::array<double, 3> sizes = {0.35, 0.4, 0.45};
const std::array<std::string, 2> owners = {"ann", "bob"};

/// What may be told to one who does not know what the others are doing.
bool to_be_expected(const errors::Error& error) {
  return error.reason() == Reason::not_found || error.reason() == Reason::in_use ||
         error.reason() == Reason::busy || error.reason() == Reason::cancelled;
}

/// Of the finest mesh.
std::uint64_t largest_estimate() {
  Backend backend;
  const std::string id = backend.create(sizes[0]);
  return operators::estimate_bytes(backend.prepare(id)->mesh());
}

/// As far as nobody holds it.
void evict(Backend& backend, const std::string& id) {
  try {
    backend.catalogue.evict(id);
  } catch (const errors::Error& error) {
    EXPECT_EQ(error.reason(), Reason::in_use);
  }
}

void prepare(Backend& backend, const std::string& id, std::mt19937& random,
             std::atomic<int>& wrong) {
  const std::shared_ptr<void> user = backend.catalogue.use(id);
  std::stop_source stop;
  std::jthread stopper;
  if (random() % 3 == 0) {
    stopper = std::jthread([&stop] { stop.request_stop(); });
  }
  const auto held = backend.prepare(id, stop.get_token());
  // It is held and used here, so it neither goes nor changes.
  wrong += held && backend.prepare(id) == held ? 0 : 1;
  // Operators grow by what theta* takes; the record tells how large they were before or after.
  held->theta_star();
  const std::uint64_t told = backend.catalogue.get(id).operator_bytes;
  wrong += told > 0 && told <= held->bytes() ? 0 : 1;
  try {
    backend.catalogue.erase(id);
    ++wrong;
  } catch (const errors::Error& error) {
    wrong += error.reason() == Reason::in_use ? 0 : 1;
  }
}

void act(Backend& backend, std::mt19937& random, std::atomic<int>& wrong) {
  const auto definition = Backend::definition(sizes.at(random() % sizes.size()));
  const std::string id =
      backend.catalogue.create(definition, "", owners.at(random() % owners.size())).id;
  switch (random() % 8) {
    case 0:
      backend.catalogue.erase(id);
      break;
    case 1:
      backend.catalogue.evict(id);
      break;
    case 2:
      backend.catalogue.warm(id, random() % 2 == 0);
      break;
    case 3:
      wrong += backend.catalogue.list({{}, 10, {}}).size() <= sizes.size() * owners.size() ? 0 : 1;
      break;
    default:
      prepare(backend, id, random, wrong);
  }
}

TEST(CatalogueStress, HoldsItsContractUnderManyThreads) {
  constexpr unsigned callers = 4;
  constexpr int calls = 25;
  BackendOptions options;
  options.memory_budget = 3 * largest_estimate() / 2;
  Backend backend(options);
  std::atomic<int> wrong{0};
  std::atomic<int> done{0};
  {
    std::vector<std::jthread> threads;
    for (unsigned t = 0; t < callers; ++t) {
      threads.emplace_back([&, t] {
        std::mt19937 random(t);
        for (int call = 0; call < calls; ++call) {
          try {
            act(backend, random, wrong);
            ++done;
          } catch (const errors::Error& error) {
            wrong += to_be_expected(error) ? 0 : 1;
          }
          const operators::CacheMetrics metrics = backend.cache.metrics();
          wrong += metrics.bytes <= metrics.budget ? 0 : 1;
        }
      });
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(done, 0);

  // Nothing has got stuck: each mesh can be brought back once the others (some of them pinned, some
  // still being made) have gone.
  std::vector<std::string> ids;
  for (const double size : sizes) {
    ids.push_back(backend.catalogue.create(Backend::definition(size), "", "ann").id);
  }
  for (const std::string& id : ids) {
    EXPECT_TRUE(eventually([&] {
      for (const std::string& other : ids) {
        evict(backend, other);
      }
      try {
        return backend.prepare(id) != nullptr;
      } catch (const errors::Error& error) {
        EXPECT_EQ(error.reason(), Reason::busy);
        return false;
      }
    }));
  }
  EXPECT_TRUE(eventually([&] { return backend.catalogue.pending() == 0; }));
}

}  // namespace
}  // namespace anticrack::meshes
