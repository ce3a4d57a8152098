// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/details.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "anticrack/v1/error.pb.h"

namespace anticrack::testing {
namespace {

constexpr const char* prefix = "type.googleapis.com/google.rpc.";

template <class Detail>
bool unpack(const google::protobuf::Any& any, const std::string& type, Detail& detail) {
  return any.type_url() == prefix + type && detail.ParseFromString(any.value());
}

}  // namespace

Details details_of(const grpc::Status& status) {
  Details details;
  v1::Status message;
  EXPECT_LT(status.error_details().size(), 4096u);
  EXPECT_TRUE(message.ParseFromString(status.error_details()));
  EXPECT_EQ(message.code(), static_cast<int>(status.error_code()));
  EXPECT_EQ(message.message(), status.error_message());
  v1::ErrorInfo info;
  v1::BadRequest bad;
  v1::RetryInfo retry;
  for (const google::protobuf::Any& any : message.details()) {
    const bool known = unpack(any, "ErrorInfo", info) || unpack(any, "BadRequest", bad) ||
                       unpack(any, "RetryInfo", retry);
    EXPECT_TRUE(known) << any.type_url();
  }
  EXPECT_EQ(info.domain(), "anticrack");
  details.reason = info.reason();
  details.metadata = {info.metadata().begin(), info.metadata().end()};
  for (const auto& violation : bad.field_violations()) {
    details.fields.push_back(violation.field());
    details.descriptions.push_back(violation.description());
  }
  details.retry_seconds =
      static_cast<double>(retry.retry_delay().seconds()) + 1e-9 * retry.retry_delay().nanos();
  return details;
}

void expect_error(const grpc::Status& status, grpc::StatusCode code, const std::string& reason,
                  const std::string& field) {
  SCOPED_TRACE(status.error_message());
  EXPECT_EQ(status.error_code(), code);
  EXPECT_FALSE(status.error_message().empty());
  const Details details = details_of(status);
  EXPECT_EQ(details.reason, reason);
  if (field.empty()) return;
  EXPECT_EQ(details.fields, std::vector<std::string>{field});
}

}  // namespace anticrack::testing
