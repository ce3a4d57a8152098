// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/json.hpp"

#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "anticrack/v1/error.pb.h"
#include "anticrack/v1/solve.pb.h"

namespace anticrack::cli {
namespace {

TEST(ToText, IsReadBackByAnotherParser) {
  const double number = 0.1 + 0.2;
  const std::string text = to_text({{"text", "a \"quoted\" \\ \x1b[0m \xc2\x9b \xff δ\n\t"},
                                    {"number", number},
                                    {"nothing", std::numeric_limits<double>::quiet_NaN()}});
  EXPECT_TRUE(
      std::ranges::all_of(text, [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); }));
  EXPECT_LT(text.find("text"), text.find("number"));
  google::protobuf::Struct parsed;
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(text, &parsed).ok());
  EXPECT_EQ(parsed.fields().at("number").number_value(), number);
  EXPECT_EQ(parsed.fields().at("text").string_value(),
            "a \"quoted\" \\ \x1b[0m \xc2\x9b \xef\xbf\xbd δ\n\t");
  EXPECT_EQ(parsed.fields().at("nothing").kind_case(), google::protobuf::Value::kNullValue);
}

TEST(ToJson, ShowsTheDetailsOfErrors) {
  v1::Job job;
  v1::ErrorInfo info;
  info.set_reason("EXPRESSION_INVALID");
  google::protobuf::Any& known = *job.mutable_status()->mutable_error()->add_details();
  known.set_type_url("type.googleapis.com/google.rpc.ErrorInfo");
  known.set_value(info.SerializeAsString());
  google::protobuf::Any& unknown = *job.mutable_status()->mutable_error()->add_details();
  unknown.set_type_url("type.googleapis.com/google.rpc.FromTheFuture");
  unknown.set_value(info.SerializeAsString());
  const std::string text = to_json(job);
  EXPECT_THAT(text, ::testing::HasSubstr("\"reason\": \"EXPRESSION_INVALID\""));
  EXPECT_THAT(text, ::testing::HasSubstr("google.rpc.FromTheFuture"));
}

}  // namespace
}  // namespace anticrack::cli
