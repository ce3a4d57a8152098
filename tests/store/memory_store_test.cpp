// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <thread>

#include "store/store.hpp"
#include "support/errors.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::store {
namespace {

using anticrack::testing::TemporaryFolder;
using anticrack::testing::throws;
using errors::Reason;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

class MemoryStore : public ::testing::Test {
 protected:
  static JobRecord job_record(const std::string& id) {
    JobRecord record;
    record.id = id;
    return record;
  }
  static MeshRecord mesh_record(const std::string& id, const std::string& title = {}) {
    MeshRecord record;
    record.id = id;
    record.title = title;
    return record;
  }
  JobRecord create(const std::string& id, const std::string& request = {},
                   const std::string& fingerprint = {}) {
    return store->create(job_record(id), request, fingerprint);
  }
  std::vector<std::string> jobs(const std::string& after, std::size_t count) {
    std::vector<std::string> ids;
    for (const JobRecord& record : store->jobs(after, count)) {
      ids.push_back(record.id);
    }
    return ids;
  }

  TemporaryFolder folder;
  std::unique_ptr<Store> store = make_memory_store(folder.path());
};

TEST_F(MemoryStore, KeepsWhatWasPutLast) {
  store->put(mesh_record("m", "first"));
  store->put(mesh_record("m", "second"));
  EXPECT_EQ(store->mesh("m")->title, "second");
  EXPECT_EQ(store->meshes("", 10).size(), 1U);
  EXPECT_FALSE(store->mesh("other"));

  create("j");
  JobRecord record = job_record("j");
  record.state = JobState::running;
  store->put(record);
  EXPECT_EQ(store->job("j")->state, JobState::running);
  EXPECT_FALSE(store->job("other"));
}

TEST_F(MemoryStore, ListsNewestFirstAndStablyUnderInsertion) {
  for (const char* id : {"a", "b", "c", "d"}) {
    create(id);
  }
  EXPECT_THAT(jobs("", 2), ElementsAre("d", "c"));
  create("e");
  store->put(job_record("b"));  // a change is no insertion
  EXPECT_THAT(jobs("c", 2), ElementsAre("b", "a"));
  EXPECT_THAT(jobs("a", 2), IsEmpty());
  EXPECT_TRUE(throws([&] { store->jobs("gone", 2); }, Reason::not_found));
  EXPECT_TRUE(throws([&] { store->meshes("gone", 2); }, Reason::not_found));
}

TEST_F(MemoryStore, GivesTheSameJobForTheSameRequest) {
  EXPECT_EQ(create("a", "request", "print").id, "a");
  EXPECT_EQ(create("b", "request", "print").id, "a");
  EXPECT_FALSE(store->job("b"));
  EXPECT_TRUE(throws([&] { create("c", "request", "other print"); }, Reason::request_id_reused,
                     "request_id"));
  EXPECT_FALSE(store->job("c"));
  EXPECT_EQ(create("d", "", "print").id, "d");
  EXPECT_EQ(create("e", "", "print").id, "e");
}

TEST_F(MemoryStore, ForgetsTheRequestWithTheJob) {
  create("a", "request", "print");
  store->put_result("a", std::make_shared<const Block>());
  store->erase_job("a");
  EXPECT_FALSE(store->job("a"));
  EXPECT_EQ(store->result("a"), nullptr);
  EXPECT_EQ(create("b", "request", "other print").id, "b");
}

TEST_F(MemoryStore, DoesNotBringBackWhatWasErased) {
  create("a");
  store->erase_job("a");
  EXPECT_TRUE(throws([&] { store->put(job_record("a")); }, Reason::not_found));
  EXPECT_TRUE(throws([&] { store->put_result("a", nullptr); }, Reason::not_found));
  EXPECT_TRUE(throws([&] { store->erase_job("a"); }, Reason::not_found));
  EXPECT_TRUE(throws([&] { store->erase_mesh("m"); }, Reason::not_found));
  EXPECT_TRUE(throws([&] { store->put_triangulation("m", nullptr, nullptr); }, Reason::not_found));
}

TEST_F(MemoryStore, KeepsTriangulationsAndResultsWithTheirRecords) {
  store->put(mesh_record("m"));
  EXPECT_EQ(store->triangulation("m"), nullptr);
  EXPECT_EQ(store->mesh_block("m"), nullptr);
  const auto mesh = std::make_shared<const mesh::Mesh>();
  const auto block = std::make_shared<const Block>();
  store->put_triangulation("m", mesh, block);
  store->put(mesh_record("m", "renamed"));
  EXPECT_EQ(store->triangulation("m"), mesh);
  EXPECT_EQ(store->mesh_block("m"), block);
  store->erase_mesh("m");
  EXPECT_EQ(store->triangulation("m"), nullptr);

  create("j");
  EXPECT_EQ(store->result("j"), nullptr);
  store->put_result("j", block);
  store->put(job_record("j"));
  EXPECT_EQ(store->result("j"), block);
}

TEST_F(MemoryStore, MakesOneJobOfARequestThatManyThreadsSend) {
  constexpr int rounds = 50;
  constexpr int senders = 4;
  std::vector<std::thread> threads;
  std::vector<std::vector<std::string>> answers(senders);
  for (int t = 0; t < senders; ++t) {
    threads.emplace_back([&, t] {
      for (int round = 0; round < rounds; ++round) {
        const std::string request = std::to_string(round);
        answers[t].push_back(create(request + "-" + std::to_string(t), request, "print").id);
        store->jobs("", 5);
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (int t = 1; t < senders; ++t) {
    EXPECT_EQ(answers[t], answers[0]);
  }
  EXPECT_EQ(store->jobs("", 1000).size(), static_cast<std::size_t>(rounds));
}

}  // namespace
}  // namespace anticrack::store
