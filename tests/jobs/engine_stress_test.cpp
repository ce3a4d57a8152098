// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <random>
#include <thread>

#include "errors/errors.hpp"
#include "jobs/engine_support.hpp"

namespace anticrack::jobs {
namespace {

using errors::Error;
using errors::Reason;

/// Reads a job's events to the end, as a client would; returns how many were wrong.
int watch(EventLog& log) {
  std::mutex mutex;
  std::condition_variable changed;
  bool woken = false;
  const auto listener = log.listen([&] {
    const std::lock_guard lock(mutex);
    woken = true;
    changed.notify_one();
  });
  int wrong = 0;
  std::uint64_t after = log.earliest() - 1;
  for (;;) {
    std::vector<NumberedEvent> events;
    try {
      events = log.read(after, 128);
    } catch (const Error& error) {
      wrong += error.reason() == Reason::sequence_trimmed ? 0 : 1;
      after = log.earliest() - 1;
      continue;
    }
    for (const NumberedEvent& event : events) {
      wrong += event.sequence == ++after ? 0 : 1;
      if (std::holds_alternative<EndEvent>(event.event)) {
        return wrong + (after == log.latest() ? 0 : 1);
      }
    }
    if (events.empty()) {
      std::unique_lock lock(mutex);
      changed.wait(lock, [&] { return woken; });
      woken = false;
    }
  }
}

TEST(EngineStress, SurvivesManyClients) {
  constexpr int clients = 4;
  constexpr int rounds = 25;
  EngineOptions options;
  options.threads = 3;
  options.max_queued_jobs = 8;
  options.max_kept_jobs = 10;
  options.event_log_bytes = 8192;
  Engine test(options);
  const std::vector<std::string> meshes = {test.backend.create(0.25), test.backend.create(0.3),
                                           test.backend.create(0.4)};
  std::atomic<int> wrong{0};
  std::atomic<int> finished{0};
  std::vector<std::thread> threads;
  for (int c = 0; c < clients; ++c) {
    threads.emplace_back([&, c] {
      std::mt19937 random(static_cast<unsigned>(c));
      for (int round = 0; round < rounds; ++round) {
        try {
          const std::string& mesh = meshes[random() % meshes.size()];
          const bool endless = random() % 3 == 0;
          records::JobSpec spec = endless ? endless_job(mesh) : short_job(mesh);
          spec.loads.push_back({"second", 1.0, ""});
          const std::string id = test.submit(spec, std::to_string(c * rounds + round));
          const auto log = test.engine.events(id);
          std::thread watcher([&] { wrong += watch(*log); });
          std::thread canceller;
          if (endless || random() % 4 == 0) {
            canceller = std::thread([&] {
              try {
                test.engine.cancel(id);
              } catch (const Error& error) {
                wrong += error.reason() == Reason::not_found ? 0 : 1;
              }
            });
          }
          test.list(5);
          test.engine.metrics();
          if (canceller.joinable()) {
            canceller.join();
          }
          watcher.join();
          ++finished;
          if (random() % 2 == 0) {
            test.engine.erase(id);
          }
          if (random() % 4 == 0) {
            test.backend.cache.evict(test.backend.catalogue.get(mesh).sha256);
          }
        } catch (const Error& error) {
          const bool expected =
              error.reason() == Reason::busy || error.reason() == Reason::not_found;
          EXPECT_TRUE(expected) << error.what();
        }
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(finished, 0);
  test.engine.stop(std::chrono::milliseconds(0));
  const EngineMetrics metrics = test.engine.metrics();
  EXPECT_EQ(metrics.jobs_created, metrics.jobs_ended);
  EXPECT_EQ(metrics.jobs_queued, 0);
  EXPECT_EQ(metrics.jobs_running, 0);
  EXPECT_TRUE(anticrack::testing::eventually([&] { return test.list(100).size() <= 10U; }));
}

}  // namespace
}  // namespace anticrack::jobs
