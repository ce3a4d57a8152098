// SPDX-License-Identifier: GPL-3.0-or-later
#include "client/error.hpp"

#include <gtest/gtest.h>

#include "anticrack/v1/error.pb.h"

namespace anticrack::client {
namespace {

void add(v1::Status& status, const std::string& type, const google::protobuf::Message& detail) {
  google::protobuf::Any& any = *status.add_details();
  any.set_type_url("type.googleapis.com/google.rpc." + type);
  any.set_value(detail.SerializeAsString());
}

v1::Status full_status() {
  v1::Status status;
  status.set_code(8);
  status.set_message("the queue is full");
  v1::ErrorInfo info;
  info.set_reason("BUSY");
  (*info.mutable_metadata())["queued"] = "1000";
  add(status, "ErrorInfo", info);
  v1::BadRequest request;
  auto& violation = *request.add_field_violations();
  violation.set_field("spec.mesh");
  violation.set_description("missing");
  add(status, "BadRequest", request);
  v1::RetryInfo retry;
  retry.mutable_retry_delay()->set_seconds(2);
  retry.mutable_retry_delay()->set_nanos(500'000'000);
  add(status, "RetryInfo", retry);
  return status;
}

void expect_full_details(const Error& error) {
  EXPECT_EQ(error.code(), Code::resource_exhausted);
  EXPECT_EQ(error.details().reason, "BUSY");
  EXPECT_EQ(error.details().metadata.at("queued"), "1000");
  ASSERT_EQ(error.details().fields.size(), 1U);
  EXPECT_EQ(error.details().fields[0].field, "spec.mesh");
  EXPECT_EQ(error.details().fields[0].description, "missing");
  EXPECT_EQ(error.details().retry_delay, std::chrono::milliseconds(2500));
}

TEST(DecodeError, ReadsAllDetails) {
  const Error error = decode_error(8, "of the call", full_status().SerializeAsString());
  EXPECT_STREQ(error.what(), "of the call");
  expect_full_details(error);
}

TEST(DecodeError, ReadsAStatusInsideAResource) {
  const Error error = decode_error(full_status());
  EXPECT_STREQ(error.what(), "the queue is full");
  expect_full_details(error);
}

TEST(DecodeError, StandsWithoutDetails) {
  const Error error = decode_error(14, "gone", "");
  EXPECT_EQ(error.code(), Code::unavailable);
  EXPECT_TRUE(error.details().reason.empty());
  EXPECT_EQ(error.details().retry_delay.count(), 0);
}

TEST(DecodeError, PassesOverWhatItCannotRead) {
  EXPECT_EQ(decode_error(3, "bad", "\xff\xff garbage").code(), Code::invalid_argument);
  EXPECT_EQ(decode_error(99, "odd", "").code(), Code::unknown);
  EXPECT_EQ(decode_error(-1, "odd", "").code(), Code::unknown);
  v1::Status status;
  google::protobuf::Any& broken = *status.add_details();
  broken.set_type_url("type.googleapis.com/google.rpc.ErrorInfo");
  broken.set_value("\xff\xff");
  status.add_details()->set_type_url("no slash");
  EXPECT_TRUE(decode_error(3, "bad", status.SerializeAsString()).details().reason.empty());
}

TEST(DecodeError, BoundsAHostileRetryDelay) {
  v1::Status status;
  v1::RetryInfo retry;
  retry.mutable_retry_delay()->set_seconds(INT64_MAX);
  add(status, "RetryInfo", retry);
  EXPECT_EQ(decode_error(8, "later", status.SerializeAsString()).details().retry_delay,
            std::chrono::hours(24));
  retry.mutable_retry_delay()->set_seconds(-5);
  status.clear_details();
  add(status, "RetryInfo", retry);
  EXPECT_EQ(decode_error(8, "later", status.SerializeAsString()).details().retry_delay.count(), 0);
}

TEST(Code, HasTheNamesOfGrpc) {
  EXPECT_EQ(name(Code::invalid_argument), "INVALID_ARGUMENT");
  EXPECT_EQ(name(Code::unauthenticated), "UNAUTHENTICATED");
}

}  // namespace
}  // namespace anticrack::client
