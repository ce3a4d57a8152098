// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <mutex>
#include <random>
#include <thread>
#include <vector>

#include "errors/errors.hpp"
#include "operators/cache_support.hpp"
#include "support/eventually.hpp"

namespace anticrack::operators {
namespace {

using errors::Reason;

/// Counts the factorisations under way per mesh: there may be one.
class Counting {
 public:
  std::shared_ptr<const MeshOperator> operator()(std::shared_ptr<const mesh::Mesh> mesh,
                                                 std::stop_token stop) {
    const mesh::Mesh* key = mesh.get();
    change(key, 1);
    try {
      auto result = MeshOperator::factorise(std::move(mesh), 1, stop);
      change(key, -1);
      return result;
    } catch (...) {
      change(key, -1);
      throw;
    }
  }
  bool overlapped() const {
    const std::lock_guard lock(_mutex);
    return _overlapped;
  }

 private:
  void change(const mesh::Mesh* key, int by) {
    const std::lock_guard lock(_mutex);
    _overlapped = _overlapped || (_running[key] += by) > 1;
  }
  mutable std::mutex _mutex;
  std::map<const mesh::Mesh*, int> _running;
  bool _overlapped = false;
};

/// What the threads share.
struct Crowd {
  Crowd() {
    for (const int columns : {4, 8, 12, 16}) {
      meshes.push_back(small_mesh(columns));
      largest = std::max<std::uint64_t>(largest, estimate_bytes(*meshes.back()));
    }
  }

  std::vector<std::shared_ptr<const mesh::Mesh>> meshes;
  std::uint64_t largest = 0;
  std::atomic<int> wrong{0};
  std::atomic<int> answered{0};
};

void check_metrics(const OperatorCache& cache, Crowd& crowd) {
  const CacheMetrics metrics = cache.metrics();
  crowd.wrong += metrics.bytes <= metrics.budget ? 0 : 1;
  crowd.wrong += metrics.pinned <= metrics.bytes ? 0 : 1;
}

/// One of the things a thread may ask for, with or without being stopped meanwhile.
void acquire_some(OperatorCache& cache, Crowd& crowd, std::mt19937& random) {
  const std::size_t which = random() % crowd.meshes.size();
  const std::string key = std::to_string(which);
  std::stop_source stop;
  std::jthread stopper;
  if (random() % 3 == 0) {
    stopper = std::jthread([&stop] { stop.request_stop(); });
  }
  try {
    const auto result = cache.acquire(key, crowd.meshes[which], stop.get_token());
    crowd.wrong += &result->mesh() == crowd.meshes[which].get() ? 0 : 1;
    crowd.wrong += cache.evict(key) == OperatorCache::Eviction::in_use ? 0 : 1;  // it is held here
    crowd.wrong += cache.contains(key) ? 0 : 1;
    ++crowd.answered;
  } catch (const errors::Error& error) {
    crowd.wrong += error.reason() == Reason::cancelled || error.reason() == Reason::busy ? 0 : 1;
  }
}

void work(OperatorCache& cache, Crowd& crowd, unsigned seed) {
  constexpr int calls = 80;
  std::mt19937 random(seed);
  for (int call = 0; call < calls; ++call) {
    const std::string key = std::to_string(random() % crowd.meshes.size());
    switch (random() % 8) {
      case 0:
        cache.pin(key);
        break;
      case 1:
      case 2:
        cache.evict(key);
        break;
      case 3:
        if (const auto found = cache.find(key)) {
          crowd.wrong += cache.contains(key) ? 0 : 1;
        }
        break;
      default:
        acquire_some(cache, crowd, random);
    }
    check_metrics(cache, crowd);
  }
}

TEST(OperatorCacheStress, HoldsItsContractUnderManyThreads) {
  constexpr unsigned callers = 6;
  Crowd crowd;
  Counting factorise;
  OperatorCache cache(2 * crowd.largest, std::ref(factorise));
  {
    std::atomic<bool> over{false};
    std::jthread watcher([&] {
      while (!over) {
        check_metrics(cache, crowd);
        std::this_thread::yield();
      }
    });
    std::vector<std::jthread> threads;
    for (unsigned t = 0; t < callers; ++t) {
      threads.emplace_back([&, t] { work(cache, crowd, t); });
    }
    threads.clear();
    over = true;
  }
  EXPECT_EQ(crowd.wrong, 0);
  EXPECT_GT(crowd.answered, 0);
  EXPECT_FALSE(factorise.overlapped());

  // Abandoned factorisations may still be on their way out. Then all goes, also what is pinned.
  ASSERT_TRUE(anticrack::testing::eventually([&] {
    for (std::size_t i = 0; i < crowd.meshes.size(); ++i) {
      cache.evict(std::to_string(i));
    }
    return cache.metrics().entries == 0;
  }));
  EXPECT_EQ(cache.metrics().bytes, 0U);
  EXPECT_EQ(cache.metrics().pinned, 0U);
}

}  // namespace
}  // namespace anticrack::operators
