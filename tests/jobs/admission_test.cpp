// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/admission.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/errors.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::error_of;
using anticrack::testing::throws;
using errors::Reason;

TEST(Admission, BoundsTheJobsThatHaveNotEnded) {
  Admission admission({2, 100, 1000});
  admission.add("", "a", 1, 1);
  admission.add("", "b", 1, 1);
  EXPECT_TRUE(throws([&] { admission.check("", "c", 1, 1, admission.bytes()); }, Reason::busy));
  admission.started();
  EXPECT_EQ(admission.waiting(), 1U);
  EXPECT_TRUE(throws([&] { admission.check("", "c", 1, 1, admission.bytes()); }, Reason::busy));
  admission.ended("", 1);
  EXPECT_NO_THROW(admission.check("", "c", 1, 1, admission.bytes()));
}

TEST(Admission, BoundsTheCasesOfAMesh) {
  Admission admission({10, 100, 1000});
  admission.add("", "a", 60, 1);
  admission.started();
  EXPECT_NO_THROW(admission.check("", "a", 40, 1, admission.bytes()));
  EXPECT_NO_THROW(admission.check("", "b", 100, 1, admission.bytes()));
  EXPECT_TRUE(throws([&] { admission.check("", "a", 41, 1, admission.bytes()); }, Reason::busy));
  admission.cases_ended("a", 1);
  EXPECT_NO_THROW(admission.check("", "a", 41, 1, admission.bytes()));
}

TEST(Admission, BoundsTheMemory) {
  Admission admission({10, 100, 1000});
  admission.add("", "a", 1, 600);
  EXPECT_NO_THROW(admission.check("", "b", 1, 400, admission.bytes()));
  EXPECT_TRUE(throws([&] { admission.check("", "b", 1, 401, admission.bytes()); }, Reason::busy));
  admission.ended("", 600);
  EXPECT_NO_THROW(admission.check("", "b", 1, 401, admission.bytes()));
  EXPECT_EQ(admission.bytes(), 0U);
}

TEST(Admission, KeepsRoomForOtherOwners) {
  Admission admission({12, 100'000, 1'000});
  const auto fill = [&](const std::string& owner, std::uint64_t bytes) {
    int jobs = 0;
    try {
      for (;; ++jobs) {
        admission.check(owner, "mesh", 1, bytes, admission.bytes());
        admission.add(owner, "mesh", 1, bytes);
      }
    } catch (const errors::Error& error) {
      EXPECT_EQ(error.reason(), Reason::busy);
      EXPECT_GT(error.retry_delay().count(), 0);
      EXPECT_THAT(error.what(), ::testing::HasSubstr("one user may"));
    }
    return jobs;
  };
  EXPECT_EQ(fill("greedy", 1), 6);
  EXPECT_EQ(fill("as greedy", 1), 3);
  EXPECT_EQ(fill("modest", 1), 1);
  for (int i = 0; i < 6; ++i) admission.ended("greedy", 1);
  EXPECT_EQ(fill("large", 200), 2);  // a third would have 600 of 1,000 bytes
  EXPECT_NO_THROW(admission.check("newcomer", "mesh", 1, 390, admission.bytes()));
}

TEST(Admission, SaysWhatCouldNeverPass) {
  const Admission admission({10, 100, 1000});
  EXPECT_TRUE(throws([&] { admission.check("", "a", 101, 1, admission.bytes()); },
                     Reason::limit_exceeded, "load_cases"));
  EXPECT_TRUE(throws([&] { admission.check("", "a", 1, 1001, admission.bytes()); },
                     Reason::limit_exceeded, "load_cases"));
}

TEST(Admission, DelaysLongerTheLongerTheQueue) {
  Admission admission({1, 100'000, 1'000'000});
  admission.add("", "a", 1, 1);
  const auto error = error_of([&] { admission.check("", "a", 1, 1, admission.bytes()); });
  ASSERT_TRUE(error);
  const auto one = error->retry_delay();
  EXPECT_GT(one.count(), 0);
  for (int i = 0; i < 100; ++i) {
    admission.add("", "a", 1, 1);
  }
  EXPECT_GT(admission.retry_delay(), one);
  for (int i = 0; i < 100'000; ++i) {
    admission.add("", "a", 1, 1);
  }
  EXPECT_LE(admission.retry_delay(), std::chrono::minutes(1));
}

}  // namespace
}  // namespace anticrack::jobs
