// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/spool.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>

#include "store/store_fixture.hpp"

namespace anticrack::store {
namespace {

constexpr std::size_t megabyte = std::size_t{1} << 20U;

std::vector<double> noise(std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::vector<double> values(count);
  for (double& value : values) value = static_cast<double>(random());
  return values;
}

records::Block piece(const std::string& name, const std::vector<double>& values) {
  records::BlockBuilder builder;
  builder.add(name + "/flags", std::vector<std::uint8_t>{1, 0, 1});
  builder.add(name + "/values", values);
  return builder.take();
}

class SpoolTest : public StoreTest {
 protected:
  SpoolTest() { reopen(); }
};

TEST_F(SpoolTest, KeepsLittleInMemoryAndMuchInAFileWithoutAName) {
  const std::shared_ptr<Spool> spool = store->new_spool();
  std::vector<Spool::Run> runs;
  for (unsigned i = 0; i < 40; ++i) {
    const std::vector<double> values = noise(20'000, i);
    runs.push_back(spool->append(std::as_bytes(std::span(values))));
    EXPECT_LE(spool->memory(), megabyte);
  }
  EXPECT_EQ(files("results"), 0U);
  for (unsigned i = 0; i < 40; ++i) {
    std::vector<double> read(20'000);
    ASSERT_EQ(runs[i].bytes, read.size() * sizeof(double));
    spool->read(runs[i].place, std::as_writable_bytes(std::span(read)));
    EXPECT_EQ(read, noise(20'000, i)) << i;
  }
}

TEST_F(SpoolTest, JoinsPartsToTheBlockThatABuilderMakes) {
  const std::shared_ptr<Spool> spool = store->new_spool();
  SpooledBlock joined(spool);
  records::BlockBuilder builder;
  std::vector<Spool::Run> runs;
  std::vector<double> together;
  for (unsigned i = 0; i < 3; ++i) {
    const std::vector<double> values = noise(100'000 + i, i);
    const records::Block part = piece(std::to_string(i), values);
    joined.add(part.arrays, spool->append(part.bytes));
    builder.add(std::to_string(i) + "/flags", std::vector<std::uint8_t>{1, 0, 1});
    builder.add(std::to_string(i) + "/values", values);
    const std::vector<double> column = noise(33, 7 + i);
    runs.push_back(spool->append(std::as_bytes(std::span(column))));
    together.insert(together.end(), column.begin(), column.end());
  }
  joined.add("columns", records::ArrayType::float64, {9, 11}, runs);
  builder.add("columns", together, {9, 11});
  const std::shared_ptr<const records::BlockSource> source = joined.finish();
  const records::Block whole = builder.finish();
  EXPECT_EQ(source->sha256(), whole.sha256);
  ASSERT_EQ(source->size(), whole.bytes.size());
  ASSERT_EQ(source->arrays().size(), whole.arrays.size());
  for (std::size_t i = 0; i < whole.arrays.size(); ++i) {
    EXPECT_EQ(source->arrays()[i].name, whole.arrays[i].name);
    EXPECT_EQ(source->arrays()[i].offset, whole.arrays[i].offset);
    EXPECT_EQ(source->arrays()[i].shape, whole.arrays[i].shape);
  }
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    const std::uint64_t offset = random() % whole.bytes.size();
    std::vector<std::byte> read(
        std::min<std::uint64_t>(random() % 5'000, whole.bytes.size() - offset));
    source->read(offset, read);
    EXPECT_TRUE(std::ranges::equal(read, std::span(whole.bytes).subspan(offset, read.size())));
  }
  end("j", source);
  EXPECT_EQ(store->result("j")->sha256(), whole.sha256);
  EXPECT_EQ(values(*store->result("j")), values(*source));
}

TEST_F(SpoolTest, KeepsInMemoryWhatTheDiskRefuses) {
  reopen(3 * megabyte);
  const std::shared_ptr<Spool> spool = store->new_spool();
  const std::vector<double> values = noise(100'000, 1);
  std::vector<Spool::Run> runs;
  for (int i = 0; i < 6; ++i) runs.push_back(spool->append(std::as_bytes(std::span(values))));
  EXPECT_GT(spool->memory(), megabyte);  // 4.8 MB beside a budget of 3 MiB
  for (const Spool::Run& run : runs) {
    std::vector<double> read(values.size());
    spool->read(run.place, std::as_writable_bytes(std::span(read)));
    EXPECT_EQ(read, values);
  }
}

TEST_F(SpoolTest, GivesItsPlaceOnTheDiskBack) {
  reopen(4 * megabyte);
  for (int i = 0; i < 3; ++i) {
    const std::shared_ptr<Spool> spool = store->new_spool();
    const std::vector<std::byte> bytes(2 * megabyte);
    spool->append(bytes);
    EXPECT_EQ(spool->memory(), 0U) << i;
  }
}

}  // namespace
}  // namespace anticrack::store
