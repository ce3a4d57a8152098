// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/contract_fixture.hpp"
#include "store/record_fields.hpp"

namespace anticrack::store {
namespace {

using anticrack::testing::AnyValue;
using anticrack::testing::Listing;
using anticrack::testing::throws;
using errors::Reason;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

class StoredJobs : public ContractTest {};

TEST_P(StoredJobs, ComeBackWholeAfterAnotherStart) {
  auto record = AnyValue(3).make<records::JobRecord>();
  record.id = "j";
  record.request_id.clear();
  store->create(record, "print");
  EXPECT_EQ(Listing::of(*store->job("j")), Listing::of(record));
  reopen();
  EXPECT_EQ(Listing::of(*store->job("j")), Listing::of(record));
  record.attempt = attempt("j");
  record.timeline.push_back(
      {records::Clock::time_point(std::chrono::nanoseconds(5)), records::JobState::running, "x"});
  store->put(record);
  reopen();
  EXPECT_EQ(Listing::of(*store->job("j")), Listing::of(record));
  EXPECT_FALSE(store->job("other"));
}

TEST_P(StoredJobs, AreListedNewestFirstAndStablyUnderInsertion) {
  for (const char* id : {"a", "b", "c", "d"}) create(id);
  EXPECT_THAT(jobs({"", 2, {}}), ElementsAre("d", "c"));
  create("e");
  store->put(job_record("b"));  // a change is not an insertion
  EXPECT_THAT(jobs({"c", 2, {}}), ElementsAre("b", "a"));
  store->erase_job("e");
  reopen();
  create("f");
  EXPECT_THAT(jobs({"", 9, {}}), ElementsAre("f", "d", "c", "b", "a"));
  EXPECT_THAT(jobs({"a", 2, {}}), IsEmpty());
  EXPECT_THAT(jobs({"", 0, {}}), IsEmpty());
  EXPECT_TRUE(throws([&] { jobs({"gone", 2, {}}); }, Reason::not_found));
}

TEST_P(StoredJobs, AreListedByOwner) {
  create("a", "ann");
  create("b", "bob");
  create("c", "ann");
  create("d", "");
  EXPECT_THAT(jobs({"", 9, "ann"}), ElementsAre("c", "a"));
  EXPECT_THAT(jobs({"c", 9, "ann"}), ElementsAre("a"));
  EXPECT_THAT(jobs({"", 9, ""}), ElementsAre("d"));
  EXPECT_THAT(jobs({"", 9, "nobody"}), IsEmpty());
  // A page of one's own does not tell whose the others are.
  EXPECT_TRUE(throws([&] { jobs({"b", 9, "ann"}); }, Reason::not_found));
}

TEST_P(StoredJobs, AreMadeOnceForARequest) {
  EXPECT_EQ(create("a", "ann", "request", "print").id, "a");
  EXPECT_EQ(create("b", "ann", "request", "print").id, "a");
  EXPECT_FALSE(store->job("b"));
  reopen();
  EXPECT_EQ(create("c", "ann", "request", "print").id, "a");
  EXPECT_TRUE(throws([&] { create("d", "ann", "request", "other"); }, Reason::request_id_reused,
                     "request_id"));
  EXPECT_FALSE(store->job("d"));
  EXPECT_EQ(create("e", "bob", "request", "other").id, "e");
  EXPECT_EQ(create("f", "ann", "", "print").id, "f");
  EXPECT_EQ(create("g", "ann", "", "print").id, "g");
  store->erase_job("a");
  EXPECT_EQ(create("h", "ann", "request", "other").id, "h");
}

TEST_P(StoredJobs, AnswerARepeatedRequestWithWhatBecameOfIt) {
  create("a", "ann", "request", "print");
  records::JobRecord record = *store->job("a");
  record.state = records::JobState::running;
  store->put(record);
  EXPECT_EQ(create("b", "ann", "request", "print").state, records::JobState::running);
}

TEST_P(StoredJobs, TellOfARepeatedRequestWithoutMakingAny) {
  create("a", "ann", "request", "print");
  EXPECT_EQ(store->created_before("ann", "request", "print").value().id, "a");
  EXPECT_TRUE(throws([&] { store->created_before("ann", "request", "other"); },
                     Reason::request_id_reused, "request_id"));
  EXPECT_FALSE(store->created_before("bob", "request", "print"));
  EXPECT_FALSE(store->created_before("bob", "", "print"));
}

TEST_P(StoredJobs, DoNotComeBackWhenErased) {
  create("a");
  store->erase_job("a");
  EXPECT_FALSE(store->job("a"));
  EXPECT_TRUE(throws([&] { store->put(job_record("a")); }, gone()));
  EXPECT_TRUE(throws([&] { store->finish(ended_record("a"), block(1)); }, gone()));
  EXPECT_TRUE(
      throws([&] { store->expire("a", records::Clock::time_point(std::chrono::seconds(9))); },
             Reason::not_found));
  EXPECT_TRUE(throws([&] { store->erase_job("a"); }, Reason::not_found));
  EXPECT_FALSE(store->job("a"));
  EXPECT_EQ(store->result("a"), nullptr);
  EXPECT_EQ(blobs(FileKind::result), 0U);
}

TEST_P(StoredJobs, AreUnfinishedUntilTheyEnd) {
  for (const char* id : {"a", "b", "c"}) create(id);
  end("d", nullptr);
  records::JobRecord running = job_record("b");
  running.state = records::JobState::running;
  store->put(running);
  store->finish(ended_record("a"), nullptr);
  reopen();
  std::vector<std::string> ids;
  for (const records::JobRecord& record : store->unfinished()) ids.push_back(record.id);
  EXPECT_THAT(ids, ElementsAre("b", "c"));
}

TEST_P(StoredJobs, EndWithTheirResults) {
  end("late", block(1), 20);
  end("early", block(2, 3), 10);
  end("empty", nullptr, 15);
  create("open");
  reopen();
  std::vector<std::string> ids;
  std::vector<std::uint64_t> bytes;
  for (const EndedJob& job : store->ended()) {
    ids.push_back(job.id);
    bytes.push_back(job.result_bytes);
  }
  EXPECT_THAT(ids, ElementsAre("early", "empty", "late"));
  EXPECT_THAT(bytes, ElementsAre(24, 0, 40));
  EXPECT_EQ(store->ended()[0].ended, records::Clock::time_point(std::chrono::seconds(10)));
  EXPECT_EQ(values(*store->result("early")), std::vector<double>(3, 2.0));
  EXPECT_EQ(store->result("empty"), nullptr);
  EXPECT_EQ(store->result("open"), nullptr);
  EXPECT_EQ(store->result("nobody"), nullptr);
}

TEST_P(StoredJobs, GiveTheirResultPieceByPiece) {
  records::BlockBuilder builder;
  builder.add("u", std::vector<double>{1, 2, 3, 4, 5, 6}, {2, 3});
  builder.add("contact", std::vector<std::int32_t>{7, 8});
  builder.add("flags", std::vector<std::uint8_t>{1, 0, 1});
  const auto written = std::make_shared<const records::Block>(builder.finish());
  const auto memory = records::in_memory(written);
  end("j", memory);
  const auto disk = store->result("j");
  for (const auto& source : {memory, disk}) {
    EXPECT_EQ(source->sha256(), written->sha256);
    ASSERT_EQ(source->size(), written->bytes.size());
    ASSERT_EQ(source->arrays().size(), 3U);
    EXPECT_EQ(source->arrays()[2].type, records::ArrayType::uint8);
    EXPECT_THAT(source->arrays()[2].shape, ElementsAre(3));
    EXPECT_EQ(source->arrays()[0].name, "u");
    EXPECT_EQ(source->arrays()[0].type, records::ArrayType::float64);
    EXPECT_THAT(source->arrays()[0].shape, ElementsAre(2, 3));
    EXPECT_EQ(source->arrays()[1].type, records::ArrayType::int32);
    EXPECT_EQ(source->arrays()[1].offset, 48U);
    std::vector<double> piece(2);
    source->read(16, std::as_writable_bytes(std::span(piece)));
    EXPECT_THAT(piece, ElementsAre(3, 4));
  }
}

TEST_P(StoredJobs, LetAReaderFinishWhatExpires) {
  end("j", block(3, many));
  const auto held = store->result("j");
  store->expire("j", records::Clock::time_point(std::chrono::seconds(9)));
  EXPECT_EQ(store->job("j")->state, records::JobState::succeeded);
  EXPECT_EQ(store->job("j")->expired, records::Clock::time_point(std::chrono::seconds(9)));
  EXPECT_EQ(store->job("j")->result_bytes, 0U);
  EXPECT_EQ(store->result("j"), nullptr);
  EXPECT_EQ(store->ended()[0].result_bytes, 0U);
  EXPECT_EQ(blobs(FileKind::result), 0U);
  EXPECT_EQ(store->usage().results, 0U);
  EXPECT_EQ(values(*held), std::vector<double>(many, 3.0));
  reopen();
  EXPECT_EQ(store->job("j")->state, records::JobState::succeeded);
  EXPECT_EQ(store->job("j")->expired, records::Clock::time_point(std::chrono::seconds(9)));
}

TEST_P(StoredJobs, DoNotExpireBeforeTheyEnd) {
  create("j");
  EXPECT_TRUE(
      throws([&] { store->expire("j", records::Clock::time_point(std::chrono::seconds(9))); },
             Reason::in_use));
  EXPECT_EQ(store->job("j")->state, records::JobState::queued);
}

TEST_P(StoredJobs, ShareEqualResultsUntilTheLastGoes) {
  end("a", block(1, many));
  end("b", block(1, many));
  end("c", block(1, many, "another name"));  // the same bytes, but not the same result
  EXPECT_EQ(blobs(FileKind::result), 2U);
  EXPECT_EQ(store->result("c")->arrays()[0].name, "another name");
  store->expire("a", records::Clock::time_point(std::chrono::seconds(9)));
  EXPECT_EQ(blobs(FileKind::result), 2U);
  EXPECT_EQ(values(*store->result("b")), std::vector<double>(many, 1.0));
  store->erase_job("b");
  EXPECT_EQ(blobs(FileKind::result), 1U);
  store->erase_job("c");
  EXPECT_EQ(blobs(FileKind::result), 0U);
  EXPECT_EQ(store->usage().results, 0U);
}

INSTANTIATE_TEST_SUITE_P(All, StoredJobs, stores, name_of_store);

}  // namespace
}  // namespace anticrack::store
