// SPDX-License-Identifier: GPL-3.0-or-later
#include "records/block.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <stdexcept>

#include "digest/digest.hpp"

namespace anticrack::records {
namespace {

using ::testing::ElementsAre;

template <class T>
std::vector<T> values(const Block& block, std::size_t index) {
  std::uint64_t count = 1;
  for (const std::uint64_t extent : block.arrays[index].shape) {
    count *= extent;
  }
  std::vector<T> result(count);
  std::memcpy(result.data(), block.bytes.data() + block.arrays[index].offset, count * sizeof(T));
  return result;
}

TEST(Block, HoldsItsArraysAtAlignedOffsets) {
  BlockBuilder builder;
  const std::vector<std::int32_t> kinds = {1, 4, 4};
  const std::vector<double> xy = {0.5, -1, 2, 3e300};
  builder.add("kinds", kinds);
  builder.add("xy", xy, {2, 2});
  builder.add("none", std::vector<double>());
  builder.add("last", kinds);
  const Block block = builder.finish();

  ASSERT_EQ(block.arrays.size(), 4U);
  EXPECT_EQ(block.arrays[0].name, "kinds");
  EXPECT_EQ(block.arrays[0].type, ArrayType::int32);
  EXPECT_THAT(block.arrays[0].shape, ElementsAre(3));
  EXPECT_EQ(block.arrays[1].type, ArrayType::float64);
  EXPECT_EQ(block.arrays[1].offset, 16U);  // 12 bytes of int32, then padding
  EXPECT_THAT(block.arrays[1].shape, ElementsAre(2, 2));
  EXPECT_THAT(block.arrays[2].shape, ElementsAre(0));
  for (const ArrayLayout& array : block.arrays) {
    EXPECT_EQ(array.offset % 8, 0U) << array.name;
  }
  EXPECT_EQ(values<std::int32_t>(block, 0), kinds);
  EXPECT_EQ(values<double>(block, 1), xy);
  EXPECT_EQ(values<std::int32_t>(block, 3), kinds);
  EXPECT_EQ(block.sha256, digest::Sha256().add(block.bytes).finish());
}

TEST(Block, IsTheSameBytesForTheSameArrays) {
  const auto build = [](double last) {
    BlockBuilder builder;
    builder.add("i", std::vector<std::int32_t>{1});
    builder.add("d", std::vector<double>{1, last});
    return builder.finish();
  };
  EXPECT_EQ(build(2).sha256, build(2).sha256);
  EXPECT_NE(build(2).sha256, build(3).sha256);
}

TEST(Block, RefusesAShapeThatDoesNotFit) {
  BlockBuilder builder;
  const std::vector<double> six(6);
  EXPECT_THROW(builder.add("a", six, {2, 2}), std::invalid_argument);
  EXPECT_THROW(builder.add("a", six, {0, 6}), std::invalid_argument);
  // The product overflows to 6.
  EXPECT_THROW(builder.add("a", six, {(UINT64_MAX / 2) + 4, 2}), std::invalid_argument);
  EXPECT_TRUE(builder.finish().arrays.empty());
}

TEST(Block, HoldsBytesAndEmptyArrays) {
  BlockBuilder builder;
  const std::vector<std::uint8_t> flags = {1, 0, 1, 1, 0, 1};
  const std::vector<double> halves = {0.5, 1.5, 2.5};
  builder.add("flags", flags, {2, 3});
  builder.add("halves", halves, {3, 1});
  builder.add("none", std::vector<std::uint8_t>(), {0, 7});
  builder.add("no columns", std::vector<double>(), {2, 0});
  const Block block = builder.finish();
  ASSERT_EQ(block.arrays.size(), 4U);
  EXPECT_EQ(block.arrays[0].type, ArrayType::uint8);
  EXPECT_EQ(values<std::uint8_t>(block, 0), flags);
  EXPECT_EQ(block.arrays[1].offset, 8U);
  EXPECT_EQ(values<double>(block, 1), halves);
  EXPECT_EQ(bytes_of(block.arrays[0]), 6U);
  EXPECT_EQ(bytes_of(block.arrays[2]), 0U);
  EXPECT_EQ(block.bytes.size(), 8 + 24U);
}

TEST(Block, LeavesTheBuilderEmpty) {
  BlockBuilder builder;
  builder.add("a", std::vector<double>{1});
  builder.finish();
  const Block block = builder.finish();
  EXPECT_TRUE(block.arrays.empty());
  EXPECT_TRUE(block.bytes.empty());
}

}  // namespace
}  // namespace anticrack::records
