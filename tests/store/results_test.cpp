// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where SQLite's store has the results of jobs, and what it says where they are damaged.
#include "store/sqlite.hpp"
#include "store/store_fixture.hpp"

namespace anticrack::store {
namespace {

using anticrack::testing::throws;
using errors::Reason;

class StoredResults : public StoreTest {};

TEST_F(StoredResults, HaveASmallResultInTheDatabase) {
  end("j", block(1));
  EXPECT_EQ(files("results"), 0U);
  EXPECT_EQ(store->job("j")->id, "j");
  const auto held = store->result("j");
  store->finish(ended_record("j"), block(2, many));
  EXPECT_EQ(files("results"), 1U);
  EXPECT_EQ(values(*store->result("j")), std::vector<double>(many, 2.0));
  store->finish(ended_record("j"), block(3));
  EXPECT_EQ(files("results"), 0U);
  store->put(ended_record("j"));  // the record alone
  reopen();
  EXPECT_EQ(values(*store->result("j")), std::vector<double>(5, 3.0));
  store->expire("j", records::Clock::time_point(std::chrono::seconds(9)));
  EXPECT_EQ(store->result("j"), nullptr);
  EXPECT_EQ(values(*held), std::vector<double>(5, 1.0));
}

TEST_F(StoredResults, AreReplaced) {
  end("j", block(1, many));
  store->finish(ended_record("j"), block(2, many));
  EXPECT_EQ(files("results"), 1U);
  EXPECT_EQ(values(*store->result("j")), std::vector<double>(many, 2.0));
  store->put(ended_record("j"));  // the record alone
  EXPECT_EQ(values(*store->result("j")), std::vector<double>(many, 2.0));
}

TEST_F(StoredResults, SayWhenASmallResultIsDamaged) {
  const std::string damages[] = {
      "UPDATE jobs SET small_result = substr(small_result, 1, length(small_result) - 1)",
      "UPDATE jobs SET small_result = substr(small_result, 1, 10)",
      "UPDATE jobs SET small_result = CAST(replace(hex(small_result), '0', 'x') AS BLOB)"};
  for (const std::string& damage : damages) {
    end(damage, block(1));
    store.reset();
    Connection(folder / "anticrack.db").execute(damage);
    reopen();
    EXPECT_TRUE(throws([&] { store->result(damage); }, Reason::storage)) << damage;
    EXPECT_TRUE(store->job(damage));
    store->erase_job(damage);
  }
}

TEST_F(StoredResults, SayWhenAResultIsDamagedOrLost) {
  end("j", block(1, many));
  std::filesystem::path path;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "results")) path = entry;
  const auto size = std::filesystem::file_size(path);
  std::filesystem::resize_file(path, size - 1);
  EXPECT_TRUE(throws([&] { store->result("j"); }, Reason::storage));
  std::filesystem::resize_file(path, 10);
  EXPECT_TRUE(throws([&] { store->result("j"); }, Reason::storage));
  std::ofstream(path) << std::string(size, 'x');
  EXPECT_TRUE(throws([&] { store->result("j"); }, Reason::storage));
  std::filesystem::remove(path);
  EXPECT_TRUE(throws([&] { store->result("j"); }, Reason::storage));
  EXPECT_TRUE(store->job("j"));
}

}  // namespace
}  // namespace anticrack::store
