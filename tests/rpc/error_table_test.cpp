// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/error_table.hpp"

#include <gtest/gtest.h>

#include <map>
#include <stdexcept>

#include "rpc/details.hpp"
#include "words/shown.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::Details;
using anticrack::testing::details_of;
using errors::Error;
using errors::Reason;

TEST(ErrorTable, MapsEveryReason) {
  const std::map<Reason, grpc::StatusCode> expected{
      {Reason::invalid_argument, grpc::StatusCode::INVALID_ARGUMENT},
      {Reason::case_invalid, grpc::StatusCode::INVALID_ARGUMENT},
      {Reason::geometry_invalid, grpc::StatusCode::INVALID_ARGUMENT},
      {Reason::mesh_invalid, grpc::StatusCode::INVALID_ARGUMENT},
      {Reason::expression_invalid, grpc::StatusCode::INVALID_ARGUMENT},
      {Reason::request_id_reused, grpc::StatusCode::INVALID_ARGUMENT},
      {Reason::limit_exceeded, grpc::StatusCode::INVALID_ARGUMENT},
      {Reason::not_found, grpc::StatusCode::NOT_FOUND},
      {Reason::not_ready, grpc::StatusCode::FAILED_PRECONDITION},
      {Reason::in_use, grpc::StatusCode::FAILED_PRECONDITION},
      {Reason::sequence_trimmed, grpc::StatusCode::OUT_OF_RANGE},
      {Reason::offset_out_of_range, grpc::StatusCode::OUT_OF_RANGE},
      {Reason::busy, grpc::StatusCode::RESOURCE_EXHAUSTED},
      {Reason::quota_exceeded, grpc::StatusCode::RESOURCE_EXHAUSTED},
      {Reason::draining, grpc::StatusCode::UNAVAILABLE},
      {Reason::disk_full, grpc::StatusCode::RESOURCE_EXHAUSTED},
      {Reason::result_expired, grpc::StatusCode::FAILED_PRECONDITION},
      {Reason::timed_out, grpc::StatusCode::DEADLINE_EXCEEDED},
      {Reason::unauthenticated, grpc::StatusCode::UNAUTHENTICATED},
      {Reason::permission_denied, grpc::StatusCode::PERMISSION_DENIED},
      {Reason::not_implemented, grpc::StatusCode::UNIMPLEMENTED},
      {Reason::cancelled, grpc::StatusCode::CANCELLED},
      {Reason::mesher_failed, grpc::StatusCode::INTERNAL},
      {Reason::numerical, grpc::StatusCode::FAILED_PRECONDITION},
      {Reason::storage, grpc::StatusCode::RESOURCE_EXHAUSTED},
      {Reason::internal, grpc::StatusCode::INTERNAL}};
  EXPECT_EQ(expected.size(), static_cast<std::size_t>(Reason::internal) + 1);
  for (const auto& [reason, status] : expected) {
    EXPECT_EQ(code(reason), status) << errors::name(reason);
    EXPECT_EQ(details_of(to_status(Error(reason, "m"))).reason, errors::name(reason));
  }
}

TEST(ErrorTable, KeepsWhatAClientIsTold) {
  const Error error = Error(Reason::busy, "the queue is full")
                          .at("job")
                          .with("limit", "7")
                          .retry_after(std::chrono::milliseconds(1500));
  const grpc::Status status = to_status(error);
  EXPECT_EQ(status.error_message(), "the queue is full");
  const Details details = details_of(status);
  EXPECT_EQ(details.fields, std::vector<std::string>{"job"});
  EXPECT_EQ(details.descriptions, std::vector<std::string>{"the queue is full"});
  EXPECT_EQ(details.metadata.at("limit"), "7");
  EXPECT_DOUBLE_EQ(details.retry_seconds, 1.5);
}

TEST(ErrorTable, CutsWhatIsLongAndStaysReadable) {
  Error error(Reason::invalid_argument, std::string(100'000, 'x'));
  for (int i = 0; i < 100; ++i) error.at("load_cases[" + std::to_string(i) + "]");
  for (int i = 0; i < 100; ++i) error.with(std::to_string(i), std::string(1'000, 'y'));
  const grpc::Status status = to_status(error);
  EXPECT_LE(status.error_details().size(), max_detail_bytes);
  const Details details = details_of(status);
  EXPECT_EQ(details.reason, "INVALID_ARGUMENT");
  ASSERT_FALSE(details.fields.empty());
  EXPECT_EQ(details.fields.front(), "load_cases[0]");
  EXPECT_TRUE(status.error_message().ends_with("..."));
}

TEST(ErrorTable, GivesAtMostTwentyViolations) {
  Error error(Reason::invalid_argument, "bad");
  for (int i = 0; i < 21; ++i) error.at(std::to_string(i));
  EXPECT_EQ(details_of(to_status(error)).fields.size(), max_violations);
}

TEST(ErrorTable, HidesTheUnexpected) {
  const auto error_of = [](auto&& thrown) {
    try {
      throw thrown;
    } catch (...) {
      return current_error("test");
    }
  };
  const Error error = error_of(std::runtime_error("secret"));
  EXPECT_EQ(error.reason(), Reason::internal);
  EXPECT_EQ(std::string(error.what()).find("secret"), std::string::npos);
  EXPECT_EQ(error_of(42).reason(), Reason::internal);
  EXPECT_EQ(error_of(std::bad_alloc()).reason(), Reason::busy);
  EXPECT_EQ(error_of(Error(Reason::in_use, "x")).reason(), Reason::in_use);
}

TEST(Printable, ReplacesWhatNoTerminalShouldGet) {
  EXPECT_EQ(words::printable("a\x1b[2Jb\nc\x7f", 100), "a?[2Jb?c?");
  EXPECT_EQ(words::printable("\xc3\xa9\xff\xc3", 100), "\xc3\xa9??");
  EXPECT_EQ(words::printable("\xed\xa0\x80", 100), "???");       // a surrogate
  EXPECT_EQ(words::printable("\xc0\xaf\xf5\x80", 100), "????");  // overlong, past U+10FFFF
  EXPECT_EQ(words::printable("\xf0\x9f\x99\x82", 100), "\xf0\x9f\x99\x82");
}

TEST(Printable, CutsBetweenCharacters) {
  EXPECT_EQ(words::printable("abcdef", 6), "abcdef");
  EXPECT_EQ(words::printable("abcdefg", 6), "abc...");
  EXPECT_EQ(words::printable("ab\xc3\xa9\xc3\xa9\xc3\xa9", 6), "ab...");
}

}  // namespace
}  // namespace anticrack::rpc
