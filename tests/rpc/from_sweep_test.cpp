// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/sweep_columns.hpp"
#include "jobs/event_codec.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "anticrack/v1/solve.pb.h"
#include "api/translations.hpp"

namespace anticrack::rpc {
namespace {

using api::layout_of;
using ::testing::ElementsAre;

v1::SweepRows rows_of(const jobs::RowsEvent& event) {
  v1::WatchJobResponse response;
  jobs::write(event, response);
  return response.sweep_rows();
}

TEST(FromSweep, TellsRows) {
  auto columns = std::make_shared<contact::SweepColumns>(2, 2, 0);
  columns->steps = {1, 2};
  columns->energy = {101, 102};
  columns->contact_length = {201, 202};
  columns->kkt = {301, 302};
  columns->displacement = {1001, 2001, 1002, 2002};
  const v1::SweepRows rows = rows_of({41, columns});
  EXPECT_EQ(rows.first_row(), 41u);
  EXPECT_THAT(rows.steps(), ElementsAre(1, 2));
  EXPECT_THAT(rows.energy(), ElementsAre(101, 102));
  EXPECT_THAT(rows.contact_length(), ElementsAre(201, 202));
  EXPECT_THAT(rows.kkt(), ElementsAre(301, 302));
  EXPECT_THAT(rows.displacement(), ElementsAre(1001, 2001, 1002, 2002));
  EXPECT_EQ(rows.slope_size(), 0);
}

TEST(FromSweep, TellsSlopesWhereAnInclusionTilts) {
  auto columns = std::make_shared<contact::SweepColumns>(1, 2, 0, true);
  columns->slope = {1, 2, 3, 4};
  EXPECT_THAT(rows_of({0, columns}).slope(), ElementsAre(1, 2, 3, 4));
}

TEST(FromSweep, TellsHowARowEnded) {
  auto columns = std::make_shared<contact::SweepColumns>(3, 0, 0);
  columns->status = {contact::Status::converged, contact::Status::not_converged,
                     contact::Status::cancelled};
  EXPECT_THAT(rows_of({0, columns}).status(), ElementsAre(v1::LoadCaseAnswer::STATUS_CONVERGED,
                                                          v1::LoadCaseAnswer::STATUS_NOT_CONVERGED,
                                                          v1::LoadCaseAnswer::STATUS_CANCELLED));
}

TEST(FromSweep, TellsArraysOfBytes) {
  records::BlockBuilder builder;
  const std::vector<std::uint8_t> closed{1, 0, 1, 1, 0, 0};
  builder.add("sweep/contact", closed, {2, 3});
  const auto block = records::in_memory(std::make_shared<const records::Block>(builder.finish()));
  const v1::BlockLayout layout = layout_of(*block);
  ASSERT_EQ(layout.arrays_size(), 1);
  EXPECT_EQ(layout.arrays(0).type(), v1::ArrayLayout::TYPE_UINT8);
  EXPECT_THAT(layout.arrays(0).shape(), ElementsAre(2u, 3u));
}

}  // namespace
}  // namespace anticrack::rpc
