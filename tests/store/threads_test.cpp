// SPDX-License-Identifier: GPL-3.0-or-later
#include <thread>

#include "store/contract_fixture.hpp"

namespace anticrack::store {
namespace {

using ::testing::Each;

class StoreThreads : public ContractTest {
 protected:
  static constexpr int workers = 4;

  /// work(index) in as many threads.
  template <class Work>
  static void together(const Work& work) {
    std::vector<std::thread> threads;
    for (int i = 0; i < workers; ++i) threads.emplace_back([&work, i] { work(i); });
    for (std::thread& thread : threads) thread.join();
  }
};

TEST_P(StoreThreads, MakeOneJobOfARequest) {
  constexpr int rounds = 20;
  std::vector<std::vector<std::string>> answers(workers);
  together([&](int t) {
    for (int round = 0; round < rounds; ++round) {
      const std::string request = std::to_string(round);
      answers[t].push_back(create(request + "-" + std::to_string(t), "", request, "print").id);
      store->jobs({"", 5, {}});
    }
  });
  EXPECT_THAT(answers, Each(answers[0]));
  EXPECT_EQ(jobs({"", 1000, {}}).size(), static_cast<std::size_t>(rounds));
}

TEST_P(StoreThreads, EachGetTheErrorOfTheirOwnChange) {
  together([&](int t) {
    for (int round = 0; round < 20; ++round) {
      const std::string id = std::to_string(t) + "-" + std::to_string(round);
      create(id);
      EXPECT_TRUE(anticrack::testing::throws([&] { create(id); }, errors::Reason::internal));
      EXPECT_TRUE(anticrack::testing::throws([&] { store->put(job_record("nobody")); }, gone()));
    }
  });
  EXPECT_EQ(jobs({"", 1000, {}}).size(), 20U * workers);
}

TEST_P(StoreThreads, ShareAResultThatComesAndGoes) {
  together([&](int t) {
    const std::string id = std::to_string(t);
    for (int round = 0; round < 15; ++round) {
      create(id);
      store->finish(ended_record(id), block(1, many));
      const auto result = store->result(id);
      ASSERT_NE(result, nullptr);
      EXPECT_EQ(values(*result), std::vector<double>(many, 1.0));
      store->result(std::to_string((t + 1) % workers));
      store->expire(id, records::Clock::time_point(std::chrono::seconds(9)));
      EXPECT_EQ(store->result(id), nullptr);
      store->erase_job(id);
    }
  });
  EXPECT_EQ(blobs(FileKind::result), 0U);
  EXPECT_EQ(store->usage().results, 0U);
}

TEST_P(StoreThreads, ShareATriangulationThatComesAndGoes) {
  const mesh::Mesh mesh = strip(4);
  together([&](int t) {
    const records::MeshRecord record = meshed_record(std::to_string(t), mesh);
    for (int round = 0; round < 15; ++round) {
      store->put(record, mesh);
      const auto read = store->triangulation(record.sha256);
      ASSERT_NE(read, nullptr);
      EXPECT_EQ(read->xy, mesh.xy);
      EXPECT_GE(store->mesh_count(), 1U);
      store->erase_mesh(record.id);
    }
  });
  EXPECT_EQ(blobs(FileKind::mesh), 0U);
}

TEST_P(StoreThreads, ShareAnUploadThatComesAndGoes) {
  together([&](int t) {
    const std::string owner = std::to_string(t);
    for (int round = 0; round < 15; ++round) {
      const std::string hash = upload("the same", owner);
      store->upload_path(hash, owner);
      store->expire_uploads(records::Clock::time_point::max());
      store->usage();
    }
  });
  EXPECT_EQ(blobs(FileKind::upload), 0U);
  EXPECT_EQ(store->usage().uploads, 0U);
}

INSTANTIATE_TEST_SUITE_P(All, StoreThreads, stores, name_of_store);

}  // namespace
}  // namespace anticrack::store
