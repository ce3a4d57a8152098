// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/from_domain.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "jobs/result_block.hpp"
#include "jobs/sample_run.hpp"
#include "records/case_record.hpp"
#include "records/job_record.hpp"
#include "records/mesh_record.hpp"
#include "support/errors.hpp"

namespace anticrack::rpc {
namespace {

using records::JobState;

TEST(FromDomain, CountsTheAttemptsOfATimeline) {
  records::JobRecord record;
  record.attempt = 2;
  const records::Clock::time_point start{std::chrono::milliseconds(1'500)};
  for (const auto& [state, detail] :
       std::vector<std::pair<JobState, std::string>>{{JobState::queued, ""},
                                                     {JobState::waiting_for_mesh, "meshing"},
                                                     {JobState::running, ""},
                                                     {JobState::queued, ""},
                                                     {JobState::running, "writing\nthe result"}}) {
    record.timeline.push_back(
        {start + std::chrono::seconds(record.timeline.size()), state, detail});
  }
  const v1::Job job = from_domain(record);
  ASSERT_EQ(job.status().timeline_size(), 5);
  EXPECT_EQ(job.status().timeline(0).time().seconds(), 1);
  EXPECT_EQ(job.status().timeline(0).time().nanos(), 500'000'000);
  EXPECT_EQ(job.status().timeline(1).state(), v1::JobStatus::STATE_WAITING_FOR_MESH);
  EXPECT_EQ(job.status().timeline(1).detail(), "meshing");
  EXPECT_EQ(job.status().timeline(2).attempt(), 1);
  EXPECT_EQ(job.status().timeline(3).attempt(), 2);
  EXPECT_EQ(job.status().timeline(4).attempt(), 2);
  EXPECT_EQ(job.status().timeline(4).detail(), "writing?the result");
}

TEST(FromDomain, AJobThatIsTakenFitsInAMessage) {
  const std::vector<std::string> inclusions(90, std::string(64, 'i'));
  records::JobRecord record;
  record.state = JobState::not_converged;
  const auto taken = [&] {
    try {
      jobs::require_answers(record.spec, inclusions);
      return true;
    } catch (const errors::Error& error) {
      EXPECT_EQ(error.reason(), errors::Reason::limit_exceeded);
      return false;
    }
  };
  records::CaseRecord answer;
  answer.status = contact::Status::not_converged;
  answer.answer.reason = std::string(200, 'r');
  answer.answer.energy = answer.answer.criterion = answer.answer.contact_length = 0.1;
  answer.answer.energy_lower = answer.answer.energy_upper = answer.answer.energy_mesh = 0.1;
  answer.answer.error_bound = answer.answer.error_bound_relative = 0.1;
  answer.answer.no_bracket = std::string(200, 'b');
  answer.answer.kkt = answer.answer.kkt_relative = {0.1, 0.2, 0.3, 0.4};
  answer.answer.warnings.assign(4, std::string(400, 'w'));
  for (const std::string& name : inclusions) {
    answer.answer.inclusions.push_back({name, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9,
                                        1.0,  1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8, 1.9});
    answer.answer.contact_intervals.push_back({name, 0.1, 0.2});
    answer.answer.tips.push_back(
        {0.1, 0.2, name, mesh::TipKind::front, false, 0.5, 0.3, {}, 0.4, 0.1, "", 0.2});
    answer.answer.boundary.push_back({name, false, 0.1, 0.2, 0.3, 0.4, 0.5, 0.1, 0.3, ""});
  }
  for (; taken(); record.cases.push_back(answer)) {
    fem::Load load;
    load.name = std::string(64, 'l');
    load.force = fem::Expression{std::string(3'000, 'x')};
    record.spec.loads.push_back(load);
  }
  record.spec.loads.pop_back();
  record.cases.pop_back();
  EXPECT_GT(record.spec.loads.size(), 130U);
  const v1::Job job = from_domain(record);
  EXPECT_LT(job.ByteSizeLong(), std::size_t{4} << 20U);
  EXPECT_EQ(job.status().answers(0).inclusions_size(), 90);
  EXPECT_EQ(job.status().answers(0).contact_intervals_size(), 0);
  EXPECT_EQ(job.status().answers(0).tips_size(), 0);
  EXPECT_EQ(job.status().answers(0).boundary_size(), 0);
}

TEST(FromDomain, PutsRunsOfSamplesBehindEachOther) {
  const auto page = std::make_shared<jobs::SamplePage>();
  for (int i = 0; i < static_cast<int>(jobs::SamplePage::capacity); ++i) {
    const auto at = static_cast<std::size_t>(i);
    page->load_case[at] = i;
    page->iteration[at] = i + 1000;
    page->contact_count[at] = i + 2000;
    page->criterion[at] = i + 0.1;
    page->energy[at] = i + 0.2;
    page->equilibrium[at] = i + 0.3;
    page->gap[at] = i + 0.4;
    page->sign[at] = i + 0.5;
    page->complementarity[at] = i + 0.6;
  }
  v1::Samples samples;
  append(samples, {{page, 250, 6}, {page, 0, 2}});
  append(samples, {{page, 7, 1}, {page, 8, 0}});
  const std::vector<int> expected = {250, 251, 252, 253, 254, 255, 0, 1, 7};
  const int count = static_cast<int>(expected.size());
  for (const int size :
       {samples.load_case_size(), samples.iteration_size(), samples.contact_count_size(),
        samples.criterion_size(), samples.energy_size(), samples.kkt_equilibrium_size(),
        samples.kkt_gap_size(), samples.kkt_sign_size(), samples.kkt_complementarity_size()}) {
    ASSERT_EQ(size, count);
  }
  for (int k = 0; k < count; ++k) {
    const int i = expected[static_cast<std::size_t>(k)];
    EXPECT_EQ(samples.load_case(k), i);
    EXPECT_EQ(samples.iteration(k), i + 1000);
    EXPECT_EQ(samples.contact_count(k), i + 2000);
    EXPECT_EQ(samples.criterion(k), i + 0.1);
    EXPECT_EQ(samples.energy(k), i + 0.2);
    EXPECT_EQ(samples.kkt_equilibrium(k), i + 0.3);
    EXPECT_EQ(samples.kkt_gap(k), i + 0.4);
    EXPECT_EQ(samples.kkt_sign(k), i + 0.5);
    EXPECT_EQ(samples.kkt_complementarity(k), i + 0.6);
  }
}

TEST(FromDomain, SaysWhoseAMeshIsAndWhetherItIsPinned) {
  records::MeshRecord record;
  record.owner = "ada";
  EXPECT_EQ(from_domain(record, true).owner(), "ada");
  EXPECT_TRUE(from_domain(record, true).pinned());
  EXPECT_FALSE(from_domain(record, false).pinned());
}

}  // namespace
}  // namespace anticrack::rpc
