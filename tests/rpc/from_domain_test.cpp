// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/from_domain.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace anticrack::rpc {
namespace {

using store::JobState;

TEST(FromDomain, CountsTheAttemptsOfATimeline) {
  store::JobRecord record;
  record.attempt = 2;
  const store::Clock::time_point start{std::chrono::milliseconds(1'500)};
  for (const auto& [state, detail] :
       std::vector<std::pair<JobState, std::string>>{{JobState::queued, ""},
                                                     {JobState::waiting_for_mesh, "meshing"},
                                                     {JobState::running, ""},
                                                     {JobState::queued, ""},
                                                     {JobState::running, "writing\nthe result"}}) {
    record.timeline.push_back(
        {start + std::chrono::seconds(record.timeline.size()), state, detail});
  }
  const v1::Job job = from_domain(record, {});
  ASSERT_EQ(job.timeline_size(), 5);
  EXPECT_EQ(job.timeline(0).time().seconds(), 1);
  EXPECT_EQ(job.timeline(0).time().nanos(), 500'000'000);
  EXPECT_EQ(job.timeline(1).state(), v1::Job::STATE_WAITING_FOR_MESH);
  EXPECT_EQ(job.timeline(1).detail(), "meshing");
  EXPECT_EQ(job.timeline(2).attempt(), 1);
  EXPECT_EQ(job.timeline(3).attempt(), 2);
  EXPECT_EQ(job.timeline(4).attempt(), 2);
  EXPECT_EQ(job.timeline(4).detail(), "writing?the result");
}

TEST(FromDomain, RepeatsWhatWasAskedFor) {
  store::JobRecord record;
  record.owner = "ada";
  record.spec.priority = store::Priority::interactive;
  record.spec.run_time_limit = std::chrono::milliseconds(2'500);
  const v1::Job job = from_domain(record, {});
  EXPECT_EQ(job.owner(), "ada");
  EXPECT_EQ(job.priority(), v1::Job::PRIORITY_INTERACTIVE);
  EXPECT_FALSE(job.has_queue_timeout());
  EXPECT_EQ(job.run_timeout().seconds(), 2);
  EXPECT_EQ(job.run_timeout().nanos(), 500'000'000);
}

TEST(FromDomain, SaysWhoseAMeshIsAndWhetherItIsPinned) {
  store::MeshRecord record;
  record.owner = "ada";
  EXPECT_EQ(from_domain(record, true).owner(), "ada");
  EXPECT_TRUE(from_domain(record, true).pinned());
  EXPECT_FALSE(from_domain(record, false).pinned());
}

}  // namespace
}  // namespace anticrack::rpc
