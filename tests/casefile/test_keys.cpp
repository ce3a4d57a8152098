// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include "casefile/keys.hpp"
#include "errors/errors.hpp"

namespace anticrack::casefile {
namespace {

using google::protobuf::FieldDescriptor;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

bool fits(Type type, const FieldDescriptor& field) {
  switch (type) {
    case Type::text:
    case Type::expression:
      return field.cpp_type() == FieldDescriptor::CPPTYPE_STRING;
    case Type::number:
    case Type::positive:
      return field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE;
    case Type::count:
      return field.cpp_type() == FieldDescriptor::CPPTYPE_INT32 ||
             field.cpp_type() == FieldDescriptor::CPPTYPE_UINT64;
    case Type::boolean:
      return field.cpp_type() == FieldDescriptor::CPPTYPE_BOOL;
    case Type::choice:
      return field.enum_type() && choices(*field.enum_type()).size() > 1;
    case Type::time:
      return field.message_type() == google::protobuf::Duration::descriptor();
    case Type::point:
      return field.message_type() == v1::Point::descriptor();
    default:
      return true;
  }
}

void expect_fields(const Keys& keys) {
  for (const Key* key : keys.known()) {
    EXPECT_NE(key->meaning, "") << key->name;
    if (key->type != Type::structure && key->field != ".") {
      const FieldDescriptor* const field = keys.field(key->path());
      ASSERT_NE(field, nullptr) << key->name;
      EXPECT_TRUE(fits(key->type, *field)) << key->name;
      EXPECT_EQ(field->is_repeated(), key->type == Type::list) << key->name;
      if (key->type == Type::table || key->type == Type::list) {
        EXPECT_EQ(field->message_type(), key->below->message()) << key->name;
      }
    }
    if (key->below) expect_fields(*key->below);
  }
}

TEST(CaseKeys, GoIntoFieldsOfTheirType) { expect_fields(case_keys); }

std::vector<std::string> names(const std::string& asked) {
  v1::ListCaseKeysRequest request;
  request.set_name(asked);
  std::vector<std::string> found;
  const v1::ListCaseKeysResponse listed = list_keys(request);
  for (const v1::CaseKey& key : listed.keys()) found.push_back(key.names(0));
  return found;
}

std::string complaint_of(const std::string& asked) {
  try {
    return "found " + names(asked).front();
  } catch (const errors::Error& error) {
    return error.what();
  }
}

TEST(CaseKeys, AreFoundByTheirPathOrItsEnd) {
  for (const char* asked : {"mesh.tip_size", "tip_size"})
    EXPECT_THAT(names(asked), ElementsAre("mesh.tip_size"));
  for (const char* asked : {"load.f", "load.opening.f", "load.0.f", "load.N.f", "f"})
    EXPECT_EQ(names(asked).front(), "load.N.f") << asked;
  EXPECT_THAT(names("units"), ElementsAre("units", "units.length", "units.force"));
  EXPECT_EQ(names("load.opening"), names("load"));
  v1::ListCaseKeysRequest request;
  request.set_name("tilt");
  const v1::CaseKey tilt = list_keys(request).keys(0);
  EXPECT_THAT(tilt.names(), ElementsAre("geometry.inclusion.N.tilt", "mesh.inclusions.N.tilt"));
  EXPECT_EQ(tilt.form(), "true or false");
  request.set_name("priority");
  const v1::CaseKey priority = list_keys(request).keys(0);
  EXPECT_EQ(priority.form(), "\"interactive\", \"normal\" or \"bulk\"");
  EXPECT_EQ(priority.field(), "JobSpec.priority");
}

TEST(CaseKeys, ThatAreNoneAreToldTheNearest) {
  EXPECT_THAT(complaint_of("tip_sise"), HasSubstr("did you mean tip_size?"));
  EXPECT_THAT(complaint_of("mesh.tip_sise"), HasSubstr("did you mean mesh.tip_size?"));
  EXPECT_THAT(complaint_of("quite else"), HasSubstr("anticrack explain"));
  EXPECT_THAT(complaint_of("."), HasSubstr("no key"));
  EXPECT_THAT(complaint_of("mesh." + std::string(300, 'x')), HasSubstr("at most 200"));
}

/// In a cell of Markdown.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (std::string_view("|*<[").find(c) != std::string_view::npos) result += '\\';
    result += c;
  }
  return result;
}

std::string guide_table() {
  std::string text = "| key | what is written | default | what it means |\n|---|---|---|---|\n";
  const v1::ListCaseKeysResponse all = list_keys({});
  for (const v1::CaseKey& key : all.keys()) {
    std::string where;
    for (const std::string& name : key.names()) where += (where.empty() ? "`" : ", `") + name + "`";
    const std::string unit = key.unit().empty() ? "" : ", in " + key.unit();
    text += "| " + where + " | " + escaped(key.form() + unit) + " | " + escaped(key.if_absent()) +
            " | " + escaped(key.meaning()) + " |\n";
  }
  return text;
}

// ANTICRACK_UPDATE=1 writes it.
TEST(CaseKeys, AreTheGuidesTable) {
  const std::string begin = "<!-- keys: made by test_casefile with ANTICRACK_UPDATE=1 -->\n",
                    end = "<!-- end of keys -->\n";
  std::stringstream guide;
  guide << std::ifstream(ANTICRACK_GUIDE).rdbuf();
  std::string text = guide.str();
  const std::size_t from = text.find(begin) + begin.size(), to = text.find(end);
  ASSERT_LE(from, to);
  if (std::getenv("ANTICRACK_UPDATE")) {
    text.replace(from, to - from, guide_table());
    std::ofstream(ANTICRACK_GUIDE) << text;
  } else {
    EXPECT_EQ(text.substr(from, to - from), guide_table())
        << "ANTICRACK_UPDATE=1 test_casefile --gtest_filter=CaseKeys.AreTheGuidesTable";
  }
}

}  // namespace
}  // namespace anticrack::casefile
