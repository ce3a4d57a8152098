// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/record_codec.hpp"

#include <gmock/gmock.h>
#include <google/protobuf/stubs/logging.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "store/record_fields.hpp"
#include "store/records.pb.h"
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
    const auto record = AnyValue(seed).make<records::MeshRecord>();
    ASSERT_EQ(Listing::of(decode_mesh_record(encode(record))), Listing::of(record)) << seed;
  }
}

TEST(RecordCodec, GivesBackEveryFieldOfAJob) {
  for (unsigned seed = 0; seed < rounds; ++seed) {
    const auto record = AnyValue(seed).make<records::JobRecord>();
    ASSERT_EQ(Listing::of(decode_job_record(encode(record))), Listing::of(record)) << seed;
  }
}

TEST(RecordCodec, GivesBackWhatNobodyFilledIn) {
  EXPECT_EQ(Listing::of(decode_mesh_record(encode(records::MeshRecord{}))),
            Listing::of(records::MeshRecord{}));
  EXPECT_EQ(Listing::of(decode_job_record(encode(records::JobRecord{}))),
            Listing::of(records::JobRecord{}));
}

/// So that no field of a message is one that nobody writes.
TEST(RecordCodec, SaysSomethingInEveryFieldOfTheMessages) {
  std::set<std::string> said;
  std::set<std::string> all;
  const auto note = [&](const auto& self, const google::protobuf::Message& message) -> void {
    const google::protobuf::Reflection& access = *message.GetReflection();
    for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
      all.insert(message.GetDescriptor()->field(i)->full_name());
    }
    std::vector<const google::protobuf::FieldDescriptor*> set;
    access.ListFields(message, &set);
    for (const auto* field : set) {
      said.insert(field->full_name());
      if (field->cpp_type() != google::protobuf::FieldDescriptor::CPPTYPE_MESSAGE) continue;
      if (!field->is_repeated()) self(self, access.GetMessage(message, field));
      for (int i = 0; field->is_repeated() && i < access.FieldSize(message, field); ++i) {
        self(self, access.GetRepeatedMessage(message, field, i));
      }
    }
  };
  for (unsigned seed = 0; seed < rounds; ++seed) {
    disk::MeshRecord mesh;
    disk::JobRecord job;
    ASSERT_TRUE(mesh.ParseFromString(encode(AnyValue(seed).make<records::MeshRecord>())));
    ASSERT_TRUE(job.ParseFromString(encode(AnyValue(seed).make<records::JobRecord>())));
    note(note, mesh);
    note(note, job);
  }
  std::vector<std::string> silent;
  std::set_difference(all.begin(), all.end(), said.begin(), said.end(), std::back_inserter(silent));
  EXPECT_THAT(silent, ::testing::UnorderedElementsAre(
                          "anticrack.v1.CreateMeshRequest.title",    // Mesh has it
                          "anticrack.v1.CreateMeshRequest.for_job",  // MeshRecord has it
                          "anticrack.v1.JobStatus.load_case_count",  // follow from the others
                          "anticrack.v1.JobStatus.load_cases_ended",
                          "anticrack.v1.Mesh.geometry",  // CreateMeshRequest has the definition
                          "anticrack.v1.Mesh.upload", "anticrack.v1.Mesh.options",
                          "anticrack.v1.Mesh.refinement",        // MeshRecord has it
                          "anticrack.v1.Mesh.pinned",            // not for longer than a process
                          "anticrack.v1.Status.code",            // follows from the reason
                          "anticrack.v1.Sweep.Matrix.packed"));  // an upload by then
}

TEST(RecordCodec, MakesUtf8OfWhatIsNot) {
  records::MeshRecord record;
  record.id = "m";
  record.inclusions = {"fibre \xff\n"};
  record.error = errors::Error(Reason::mesh_invalid, "\xc3 is not a name");
  const records::MeshRecord back = decode_mesh_record(encode(record));
  EXPECT_EQ(back.inclusions[0], "fibre ??");
  EXPECT_STREQ(back.error->what(), "? is not a name");
}

TEST(RecordCodec, KeepsNoArrays) {
  records::JobRecord record;
  record.spec.loads.push_back({"load", fem::Array{"hash", true, nullptr}});
  std::get<fem::Array>(record.spec.loads[0].force).values =
      std::make_shared<const std::vector<double>>(1000, 1.0);
  const std::string bytes = encode(record);
  EXPECT_LT(bytes.size(), 1000U);
  const records::JobRecord back = decode_job_record(bytes);
  EXPECT_EQ(std::get<fem::Array>(back.spec.loads[0].force).values, nullptr);
}

TEST(RecordCodec, RefusesWhatIsNoRecord) {
  EXPECT_TRUE(throws([] { decode_mesh_record("nothing"); }, Reason::storage));
  EXPECT_TRUE(throws([] { decode_job_record("nothing"); }, Reason::storage));
  EXPECT_TRUE(throws([] { decode_mesh_record(""); }, Reason::storage));
  EXPECT_TRUE(throws([] { decode_job_record(""); }, Reason::storage));
}

TEST(RecordCodec, RefusesEveryCutOffRecordOrReadsARecord) {
  const google::protobuf::LogSilencer silencer;  // of texts that end within a character
  const std::string bytes = encode(AnyValue(7).make<records::JobRecord>());
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
