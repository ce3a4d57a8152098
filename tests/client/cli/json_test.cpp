// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/json.hpp"

#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <limits>

#include "anticrack/v1/error.pb.h"
#include "anticrack/v1/solve.pb.h"

namespace anticrack::cli {
namespace {

TEST(JsonWriter, WritesNestedDocumentsInOrder) {
  JsonWriter json;
  json.begin_object().value("b", "text").value("a", std::int64_t{3}).begin_array("list");
  json.element("one").begin_object().value("x", 0.5).end_object().end_array();
  json.begin_array("none").end_array().end_object();
  EXPECT_EQ(json.text(),
            "{\n"
            "  \"b\": \"text\",\n"
            "  \"a\": 3,\n"
            "  \"list\": [\n"
            "    \"one\",\n"
            "    {\n"
            "      \"x\": 0.5\n"
            "    }\n"
            "  ],\n"
            "  \"none\": []\n"
            "}");
}

TEST(JsonWriter, IsReadBackByAnotherParser) {
  const double number = 0.1 + 0.2;
  const std::string text = "a \"quoted\" \\ \x1b[0m \xff δ";
  JsonWriter json;
  json.begin_object().value("number", number).value("text", text);
  json.value("nothing", std::numeric_limits<double>::quiet_NaN()).end_object();
  google::protobuf::Struct parsed;
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(json.text(), &parsed).ok());
  EXPECT_EQ(parsed.fields().at("number").number_value(), number);
  EXPECT_EQ(parsed.fields().at("text").string_value(), "a \"quoted\" \\ ?[0m ? δ");
  EXPECT_EQ(parsed.fields().at("nothing").kind_case(), google::protobuf::Value::kNullValue);
}

TEST(JsonWriter, KeepsLineEndsAndTabs) {
  JsonWriter json;
  json.begin_object().value("text", "one\n\ttwo\n").end_object();
  google::protobuf::Struct parsed;
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(json.text(), &parsed).ok());
  EXPECT_EQ(parsed.fields().at("text").string_value(), "one\n\ttwo\n");
}

TEST(ToJson, ShowsTheDetailsOfErrors) {
  v1::Job job;
  v1::ErrorInfo info;
  info.set_reason("EXPRESSION_INVALID");
  google::protobuf::Any& known = *job.mutable_error()->add_details();
  known.set_type_url("type.googleapis.com/google.rpc.ErrorInfo");
  known.set_value(info.SerializeAsString());
  google::protobuf::Any& unknown = *job.mutable_error()->add_details();
  unknown.set_type_url("type.googleapis.com/google.rpc.FromTheFuture");
  unknown.set_value(info.SerializeAsString());
  const std::string text = to_json(job);
  EXPECT_THAT(text, ::testing::HasSubstr("\"reason\": \"EXPRESSION_INVALID\""));
  EXPECT_THAT(text, ::testing::HasSubstr("google.rpc.FromTheFuture"));
}

TEST(ToJson, KeepsTheProtosFieldNamesAndZeros) {
  v1::Job job;
  job.set_name("jobs/1");
  job.set_state(v1::Job::STATE_RUNNING);
  job.add_load_cases()->set_name("one");
  const std::string text = to_json(job);
  EXPECT_THAT(text, ::testing::HasSubstr("\"load_cases\""));
  EXPECT_THAT(text, ::testing::HasSubstr("\"result_bytes\": \"0\""));
  EXPECT_THAT(text, ::testing::HasSubstr("\"STATE_RUNNING\""));
  v1::Job back;
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(text, &back).ok());
  EXPECT_EQ(back.SerializeAsString(), job.SerializeAsString());
}

}  // namespace
}  // namespace anticrack::cli
