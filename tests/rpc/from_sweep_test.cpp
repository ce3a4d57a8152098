// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/sweep_columns.hpp"
#include "rpc/from_domain.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "api/translations.hpp"

namespace anticrack::rpc {
namespace {

using api::layout_of;
using ::testing::ElementsAre;

/// Rows that tell their number: 100 + k, 200 + k, ...
jobs::RowsEvent event_of(std::uint64_t first_row, std::size_t rows, std::size_t inclusions) {
  auto columns = std::make_shared<contact::SweepColumns>(rows, inclusions, 1);
  for (std::size_t k = 0; k < rows; ++k) {
    const auto number = static_cast<double>(k);
    columns->status[k] = contact::Status::converged;
    columns->steps[k] = static_cast<std::int32_t>(k);
    columns->energy[k] = 100 + number;
    columns->contact_length[k] = 200 + number;
    columns->kkt[k] = 300 + number;
    for (std::size_t i = 0; i < inclusions; ++i) {
      columns->displacement[k * inclusions + i] = 1000 * static_cast<double>(i + 1) + number;
    }
  }
  return {first_row, columns};
}

TEST(FromSweep, TellsRowsFromThePlaceOn) {
  v1::SweepRows rows;
  append(rows, event_of(40, 5, 2), 1, 2);
  EXPECT_EQ(rows.first_row(), 41u);
  EXPECT_THAT(rows.steps(), ElementsAre(1, 2));
  EXPECT_THAT(rows.energy(), ElementsAre(101, 102));
  EXPECT_THAT(rows.contact_length(), ElementsAre(201, 202));
  EXPECT_THAT(rows.kkt(), ElementsAre(301, 302));
  EXPECT_THAT(rows.displacement(), ElementsAre(1001, 2001, 1002, 2002));
  EXPECT_THAT(rows.status(), ElementsAre(v1::LoadCaseAnswer::STATUS_CONVERGED,
                                         v1::LoadCaseAnswer::STATUS_CONVERGED));
}

TEST(FromSweep, TellsNoMoreThanThereIs) {
  v1::SweepRows rows;
  append(rows, event_of(0, 3, 1), 2, 100);
  EXPECT_EQ(rows.first_row(), 2u);
  EXPECT_THAT(rows.steps(), ElementsAre(2));
  append(rows, event_of(0, 3, 1), 3, 1);
  EXPECT_EQ(rows.steps_size(), 1);
}

TEST(FromSweep, GoesOnWhereTheMessageEnds) {
  v1::SweepRows rows;
  append(rows, event_of(10, 2, 1), 0, 2);
  append(rows, event_of(12, 2, 1), 0, 1);
  EXPECT_EQ(rows.first_row(), 10u);
  EXPECT_THAT(rows.steps(), ElementsAre(0, 1, 0));
  EXPECT_THAT(rows.displacement(), ElementsAre(1000, 1001, 1000));
}

TEST(FromSweep, TellsSlopesWhereAnInclusionTilts) {
  auto columns = std::make_shared<contact::SweepColumns>(3, 2, 0, true);
  for (std::size_t i = 0; i < columns->slope.size(); ++i) {
    columns->slope[i] = static_cast<double>(i);
  }
  v1::SweepRows rows;
  append(rows, {0, columns}, 1, 2);
  EXPECT_THAT(rows.slope(), ElementsAre(4, 5, 6, 7, 8, 9, 10, 11));
  v1::SweepRows none;
  append(none, event_of(0, 3, 2), 1, 2);
  EXPECT_EQ(none.slope_size(), 0);
}

TEST(FromSweep, TellsRowsOfAMeshWithoutInclusions) {
  v1::SweepRows rows;
  append(rows, event_of(0, 2, 0), 0, 2);
  EXPECT_EQ(rows.status_size(), 2);
  EXPECT_EQ(rows.displacement_size(), 0);
}

TEST(FromSweep, TellsHowARowEnded) {
  auto columns = std::make_shared<contact::SweepColumns>(3, 0, 0);
  columns->status = {contact::Status::converged, contact::Status::not_converged,
                     contact::Status::cancelled};
  v1::SweepRows rows;
  append(rows, {0, columns}, 0, 3);
  EXPECT_THAT(rows.status(), ElementsAre(v1::LoadCaseAnswer::STATUS_CONVERGED,
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
