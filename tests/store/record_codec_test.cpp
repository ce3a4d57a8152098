// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/record_codec.hpp"

#include <gtest/gtest.h>

#include "store/record_fields.hpp"
#include "support/errors.hpp"

namespace anticrack::store {
namespace {

using anticrack::testing::AnyValue;
using anticrack::testing::Listing;
using anticrack::testing::throws;
using errors::Reason;

constexpr unsigned rounds = 300;

TEST(RecordCodec, GivesBackEveryFieldOfAMesh) {
  for (unsigned seed = 0; seed < rounds; ++seed) {
    const auto record = AnyValue(seed).make<MeshRecord>();
    ASSERT_EQ(Listing::of(decode_mesh_record(encode(record))), Listing::of(record)) << seed;
  }
}

TEST(RecordCodec, GivesBackEveryFieldOfAJob) {
  for (unsigned seed = 0; seed < rounds; ++seed) {
    const auto record = AnyValue(seed).make<JobRecord>();
    ASSERT_EQ(Listing::of(decode_job_record(encode(record))), Listing::of(record)) << seed;
  }
}

TEST(RecordCodec, GivesBackWhatNobodyFilledIn) {
  EXPECT_EQ(Listing::of(decode_mesh_record(encode(MeshRecord{}))), Listing::of(MeshRecord{}));
  EXPECT_EQ(Listing::of(decode_job_record(encode(JobRecord{}))), Listing::of(JobRecord{}));
}

TEST(RecordCodec, ReadsAJobFromBeforeThereWereSweeps) {
  auto record = AnyValue(3).make<JobRecord>();
  record.spec.sweep.reset();
  record.sweep = {};
  const std::string bytes = encode(record);
  const std::string empty_sweep("\x72\0", 2);  // the last field, number 14, of length 0
  ASSERT_TRUE(bytes.ends_with(empty_sweep));
  const JobRecord back = decode_job_record(bytes.substr(0, bytes.size() - empty_sweep.size()));
  EXPECT_EQ(Listing::of(back), Listing::of(record));
}

TEST(RecordCodec, KeepsNoArrays) {
  JobRecord record;
  record.spec.loads.push_back({"load", fem::Array{"hash", true, nullptr}});
  std::get<fem::Array>(record.spec.loads[0].force).values =
      std::make_shared<const std::vector<double>>(1000, 1.0);
  record.cases.resize(1);
  record.cases[0].answer.traces.resize(1);
  record.cases[0].answer.traces[0].jump.resize(1000);
  const std::string bytes = encode(record);
  EXPECT_LT(bytes.size(), 1000U);
  const JobRecord back = decode_job_record(bytes);
  EXPECT_EQ(std::get<fem::Array>(back.spec.loads[0].force).values, nullptr);
  EXPECT_TRUE(back.cases[0].answer.traces.empty());
}

TEST(RecordCodec, RefusesWhatIsNoRecord) {
  EXPECT_TRUE(throws([] { decode_mesh_record("nothing"); }, Reason::storage));
  EXPECT_TRUE(throws([] { decode_job_record("nothing"); }, Reason::storage));
  EXPECT_TRUE(throws([] { decode_mesh_record(""); }, Reason::storage));
  EXPECT_TRUE(throws([] { decode_job_record(""); }, Reason::storage));
}

TEST(RecordCodec, RefusesEveryCutOffRecordOrReadsARecord) {
  const std::string bytes = encode(AnyValue(7).make<JobRecord>());
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    try {
      decode_job_record(std::string_view(bytes).substr(0, length));
    } catch (const errors::Error& error) {
      EXPECT_EQ(error.reason(), Reason::storage);
    }
  }
}

}  // namespace
}  // namespace anticrack::store
