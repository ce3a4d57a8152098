// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/job_queue.hpp"

#include <gtest/gtest.h>

#include "operators/mesh_operator.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::jobs {
namespace {

using JobPtr = JobQueue::JobPtr;
using Operator = JobQueue::Operator;
using namespace std::chrono_literals;

class Queue : public ::testing::Test {
 protected:
  JobPtr add(const std::string& mesh) {
    store::JobRecord record;
    record.id = std::to_string(++_number);
    record.spec.mesh = mesh;
    auto job = std::make_shared<LiveJob>(_number, record, 1024);
    queue.add(job);
    return job;
  }
  static Operator nothing(const std::string& /*mesh*/) { return nullptr; }
  /// Finds the operators of one mesh.
  auto only(const std::string& ready) {
    return
        [this, ready](const std::string& mesh) { return mesh == ready ? some_operator : nullptr; };
  }

  const JobQueue::Time now = std::chrono::steady_clock::now();
  const Operator some_operator = operators::MeshOperator::factorise(
      std::make_shared<const mesh::Mesh>(anticrack::testing::structured_mesh()), 1, {});
  JobQueue queue{2};

 private:
  std::uint64_t _number = 0;
};

TEST_F(Queue, PreparesInOrderOneJobAMesh) {
  const JobPtr first = add("a");
  const JobPtr second = add("a");
  const JobPtr third = add("b");
  EXPECT_EQ(queue.next_to_prepare(now), first);
  EXPECT_EQ(queue.next_to_prepare(now), third);
  EXPECT_EQ(queue.next_to_prepare(now), nullptr);
  EXPECT_EQ(queue.size(), 3U);
  EXPECT_EQ(queue.waiting(), 1U);
  queue.drop(*first);
  EXPECT_EQ(queue.next_to_prepare(now), second);
  EXPECT_EQ(queue.size(), 2U);
}

TEST_F(Queue, PreparesNoMoreAheadThanItsLimit) {
  const JobPtr first = add("a");
  const JobPtr second = add("b");
  const JobPtr third = add("c");
  queue.prepared(queue.next_to_prepare(now));
  queue.prepared(queue.next_to_prepare(now));
  EXPECT_EQ(queue.next_to_prepare(now), nullptr);
  EXPECT_EQ(queue.next_to_start(nothing), first);
  EXPECT_EQ(queue.next_to_prepare(now), third);
  EXPECT_EQ(queue.next_to_start(nothing), second);
  EXPECT_EQ(queue.next_to_start(nothing), nullptr);
}

TEST_F(Queue, StartsAJobWhoseMeshIsReadyBeforeOneThatWaits) {
  const JobPtr waits = add("slow");
  const JobPtr ready = add("ready");
  EXPECT_EQ(queue.next_to_prepare(now), waits);
  EXPECT_EQ(queue.next_to_start(only("ready")), ready);
  EXPECT_EQ(ready->mesh_operator, some_operator);
  EXPECT_EQ(queue.next_to_start(only("ready")), nullptr);
}

TEST_F(Queue, StartsTheOlderOfPreparedAndReady) {
  const JobPtr prepared = add("a");
  const JobPtr ready = add("b");
  queue.prepared(queue.next_to_prepare(now));
  EXPECT_EQ(queue.next_to_start(only("b")), prepared);
  EXPECT_EQ(queue.next_to_start(only("b")), ready);

  const JobPtr older = add("b");
  const JobPtr newer = add("a");
  add("c");
  EXPECT_EQ(queue.next_to_prepare(now), older);
  queue.prepare_again(older, now);
  queue.prepared(queue.next_to_prepare(now));
  EXPECT_EQ(queue.next_to_start(only("b")), older);
}

TEST_F(Queue, AsksForEachMeshOnce) {
  for (int i = 0; i < 5; ++i) {
    add("a");
    add("b");
  }
  int asked = 0;
  EXPECT_EQ(queue.next_to_start([&](const std::string&) {
    ++asked;
    return nullptr;
  }),
            nullptr);
  EXPECT_EQ(asked, 2);
}

TEST_F(Queue, PutsAJobBackInItsPlaceUntilItsTime) {
  const JobPtr first = add("a");
  const JobPtr second = add("b");
  queue.prepare_again(queue.next_to_prepare(now), now + 1s);
  EXPECT_EQ(queue.next_retry(now), now + 1s);
  EXPECT_EQ(queue.next_to_prepare(now), second);
  EXPECT_EQ(queue.next_to_prepare(now), nullptr);
  // Its time has come: that nobody takes it is no reason to wake up again.
  EXPECT_EQ(queue.next_retry(now + 1s), std::nullopt);
  EXPECT_EQ(queue.next_to_prepare(now + 1s), first);
}

TEST_F(Queue, LetsGoOfJobsThatNobodyPrepares) {
  const JobPtr preparing = add("a");
  const JobPtr waiting = add("a");
  EXPECT_EQ(queue.next_to_prepare(now), preparing);
  EXPECT_FALSE(queue.remove(*preparing));
  EXPECT_TRUE(queue.remove(*waiting));
  EXPECT_FALSE(queue.remove(*waiting));
  queue.prepared(preparing);
  EXPECT_TRUE(queue.remove(*preparing));
  EXPECT_EQ(queue.size(), 0U);
  EXPECT_EQ(queue.next_to_start(nothing), nullptr);
}

}  // namespace
}  // namespace anticrack::jobs
