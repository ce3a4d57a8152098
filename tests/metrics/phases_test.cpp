// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/phases.hpp"
#include "records/job_record.hpp"

#include <gtest/gtest.h>

namespace anticrack::metrics {
namespace {

using records::JobState;
using std::chrono::seconds;

const records::Clock::time_point begin{seconds(1'000'000)};

double seconds_in(const PhaseTimes& times, Phase phase) {
  return times[static_cast<std::size_t>(phase)].count();
}

TEST(Phases, AreKnownByStateAndDetail) {
  EXPECT_EQ(phase_of({begin, JobState::queued, ""}), Phase::queued);
  EXPECT_EQ(phase_of({begin, JobState::waiting_for_mesh, ""}), Phase::waiting);
  EXPECT_EQ(phase_of({begin, JobState::waiting_for_mesh, "meshing"}), Phase::meshing);
  EXPECT_EQ(phase_of({begin, JobState::waiting_for_mesh, "factorising"}), Phase::factorizing);
  EXPECT_EQ(phase_of({begin, JobState::running, ""}), Phase::solving);
  EXPECT_EQ(phase_of({begin, JobState::running, "writing the result"}), Phase::writing);
}

TEST(Phases, LastUntilTheNextAndAddUpOverAttempts) {
  records::JobRecord job;
  job.timeline = {{begin, JobState::queued, ""},
                  {begin + seconds(1), JobState::waiting_for_mesh, "meshing"},
                  {begin + seconds(3), JobState::waiting_for_mesh, "factorising"},
                  {begin + seconds(7), JobState::running, ""},
                  {begin + seconds(15), JobState::queued, ""},
                  {begin + seconds(31), JobState::running, ""},
                  {begin + seconds(63), JobState::running, "writing the result"}};
  job.ended = begin + seconds(127);
  const PhaseTimes times = phase_times(job);
  EXPECT_EQ(seconds_in(times, Phase::queued), 1 + 16);
  EXPECT_EQ(seconds_in(times, Phase::waiting), 0);
  EXPECT_EQ(seconds_in(times, Phase::meshing), 2);
  EXPECT_EQ(seconds_in(times, Phase::factorizing), 4);
  EXPECT_EQ(seconds_in(times, Phase::solving), 8 + 32);
  EXPECT_EQ(seconds_in(times, Phase::writing), 64);
}

TEST(Phases, EndWithTheJob) {
  records::JobRecord job;
  EXPECT_EQ(phase_times(job), PhaseTimes{}) << "no timeline";
  job.timeline = {{begin, JobState::running, ""}, {begin + seconds(2), JobState::succeeded, ""}};
  job.ended = begin + seconds(9);
  EXPECT_EQ(seconds_in(phase_times(job), Phase::solving), 2);
  job.timeline = {{begin, JobState::running, ""}};
  job.ended = begin - seconds(1);
  EXPECT_EQ(seconds_in(phase_times(job), Phase::solving), 0) << "the clock was set back";
}

}  // namespace
}  // namespace anticrack::metrics
