// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <thread>
#include <vector>

#include "errors/errors.hpp"
#include "operators/cache_support.hpp"

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

TEST(OperatorCacheStress, HoldsItsContractUnderManyThreads) {
  constexpr int callers = 6;
  constexpr int calls = 60;
  std::vector<std::shared_ptr<const mesh::Mesh>> meshes;
  std::uint64_t largest = 0;
  for (const int columns : {4, 8, 12, 16}) {
    meshes.push_back(small_mesh(columns));
    largest = std::max<std::uint64_t>(largest, estimate_bytes(*meshes.back()));
  }
  const std::uint64_t budget = 2 * largest;
  Counting factorise;
  OperatorCache cache(budget, std::ref(factorise));
  std::atomic<int> wrong{0};
  std::atomic<int> answered{0};

  std::vector<std::thread> threads;
  for (int t = 0; t < callers; ++t) {
    threads.emplace_back([&, t] {
      std::mt19937 random(static_cast<unsigned>(t));
      for (int call = 0; call < calls; ++call) {
        const std::size_t which = random() % meshes.size();
        const std::string key = std::to_string(which);
        std::stop_source stop;
        std::jthread stopper;
        if (random() % 3 == 0) {
          stopper = std::jthread([&stop] { stop.request_stop(); });
        }
        try {
          const auto result = cache.acquire(key, meshes[which], stop.get_token());
          wrong += &result->mesh() == meshes[which].get() ? 0 : 1;
          wrong += cache.evict(key) ? 1 : 0;  // it is held here
          ++answered;
        } catch (const errors::Error& error) {
          wrong += error.reason() == Reason::cancelled || error.reason() == Reason::busy ? 0 : 1;
        }
        wrong += cache.metrics().bytes <= budget ? 0 : 1;
        if (random() % 8 == 0) {
          cache.evict(key);
        }
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(answered, 0);
  EXPECT_FALSE(factorise.overlapped());
  std::uint64_t left = 0;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    if (const auto found = cache.find(std::to_string(i))) {
      left += found->bytes();
    }
  }
  // Abandoned factorisations may still be on their way out.
  EXPECT_LE(left, cache.metrics().bytes);
}

}  // namespace
}  // namespace anticrack::operators
