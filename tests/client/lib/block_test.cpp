// SPDX-License-Identifier: GPL-3.0-or-later
#include "client/block.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "client/error.hpp"
#include "client/lib/sample_block.hpp"

namespace anticrack::client {
namespace {

const std::string bytes = sample_bytes(80);

template <class Action>
std::string damage(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Code::data_loss);
    return error.what();
  }
  return "";
}

TEST(BlockReceiver, PutsChunksOfSeveralStreamsTogether) {
  BlockReceiver receiver;
  receiver.accept(sample_layout(bytes));
  receiver.accept(sample_chunk(bytes, 0, 50));
  EXPECT_FALSE(receiver.complete());
  EXPECT_EQ(receiver.offset(), 50U);
  receiver.accept(sample_layout(bytes));
  receiver.accept(sample_chunk(bytes, 50, 30));
  ASSERT_TRUE(receiver.complete());
  const Block block = receiver.finish();
  ASSERT_EQ(block.bytes.size(), bytes.size());
  EXPECT_EQ(std::memcmp(block.bytes.data(), bytes.data(), bytes.size()), 0);
  EXPECT_EQ(block.layout.arrays(0).name(), "nodes");
}

TEST(BlockReceiver, TakesALayoutInParts) {
  v1::BlockLayout first = sample_layout(bytes);
  first.set_array_count(3);
  v1::BlockLayout second = first;
  second.set_first_array(1);
  *second.add_arrays() = second.arrays(0);
  BlockReceiver receiver;
  EXPECT_THAT(damage([&] { receiver.accept(second); }), ::testing::HasSubstr("where 0 was due"));
  receiver.accept(first);
  receiver.accept(sample_chunk(bytes, 0, 80));
  EXPECT_FALSE(receiver.complete());
  receiver.accept(first);  // of another stream
  receiver.accept(second);
  EXPECT_TRUE(receiver.complete());
  receiver.accept(second);
  EXPECT_EQ(receiver.finish().layout.arrays_size(), 3);
}

TEST(BlockReceiver, TakesAnEmptyBlock) {
  BlockReceiver receiver;
  EXPECT_FALSE(receiver.complete());
  receiver.accept(sample_layout(""));
  EXPECT_TRUE(receiver.complete());
  EXPECT_TRUE(receiver.finish().bytes.empty());
}

TEST(BlockReceiver, RefusesAWrongChecksum) {
  BlockReceiver receiver;
  receiver.accept(sample_layout(bytes));
  v1::BlockChunk chunk = sample_chunk(bytes, 0, 50);
  (*chunk.mutable_data())[7] ^= 1;
  EXPECT_THAT(damage([&] { receiver.accept(chunk); }), ::testing::HasSubstr("checksum"));
  EXPECT_EQ(receiver.offset(), 0U) << "nothing of it is kept";
}

TEST(BlockReceiver, RefusesAGapAndARepetition) {
  BlockReceiver receiver;
  receiver.accept(sample_layout(bytes));
  EXPECT_NE(damage([&] { receiver.accept(sample_chunk(bytes, 8, 8)); }), "");
  receiver.accept(sample_chunk(bytes, 0, 8));
  EXPECT_NE(damage([&] { receiver.accept(sample_chunk(bytes, 0, 8)); }), "");
}

TEST(BlockReceiver, RefusesMoreThanAnnounced) {
  BlockReceiver receiver;
  receiver.accept(sample_layout(bytes.substr(0, 40)));
  EXPECT_THAT(damage([&] { receiver.accept(sample_chunk(bytes, 0, 41)); }),
              ::testing::HasSubstr("40 bytes"));
}

TEST(BlockReceiver, RefusesAnotherLayout) {
  BlockReceiver receiver;
  receiver.accept(sample_layout(bytes));
  EXPECT_THAT(damage([&] { receiver.accept(sample_layout(sample_bytes(88))); }),
              ::testing::HasSubstr("changed"));
}

TEST(BlockReceiver, RefusesAChunkBeforeTheLayout) {
  BlockReceiver receiver;
  EXPECT_NE(damage([&] { receiver.accept(sample_chunk(bytes, 0, 8)); }), "");
}

TEST(BlockReceiver, ChecksTheWholeHash) {
  BlockReceiver receiver;
  v1::BlockLayout layout = sample_layout(bytes);
  layout.set_sha256(std::string(64, '0'));
  receiver.accept(layout);
  receiver.accept(sample_chunk(bytes, 0, 80));
  EXPECT_THAT(damage([&] { receiver.finish(); }), ::testing::HasSubstr("sha256"));
}

TEST(BlockReceiver, DoesNotBelieveAnAnnouncedSize) {
  BlockReceiver receiver;
  v1::BlockLayout layout = sample_layout(bytes);
  layout.set_size(std::uint64_t{1} << 62);
  receiver.accept(layout);  // must not allocate that
  receiver.accept(sample_chunk(bytes, 0, 80));
  EXPECT_FALSE(receiver.complete());
  EXPECT_NE(damage([&] { receiver.finish(); }), "");
}

}  // namespace
}  // namespace anticrack::client
