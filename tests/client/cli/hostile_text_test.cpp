// SPDX-License-Identifier: GPL-3.0-or-later
//
// Whatever text a server sends, in whichever field: it neither controls the terminal nor adds
// lines.
#include <google/protobuf/message.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <sstream>

#include "cli/json.hpp"
#include "cli/tables.hpp"
#include "words/shown.hpp"

namespace anticrack::cli {
namespace {

constexpr const char* hostile =
    "a\u202eb\u2066c\u2069\u200e\u061c\u200b\u2028\x1b[2J\x07\nFORGED\rFORGED";

/// Every text of the message and of those in it, so deep; arrays get two elements each.
void fill(google::protobuf::Message& message, int depth) {
  const google::protobuf::Reflection& values = *message.GetReflection();
  const google::protobuf::Descriptor& type = *message.GetDescriptor();
  using Field = google::protobuf::FieldDescriptor;
  for (int i = 0; i < type.field_count(); ++i) {
    const Field* field = type.field(i);
    const int count = field->is_repeated() ? 2 : 1;
    const bool known = type.full_name() != "google.protobuf.Any";
    for (int k = 0; k < count && known; ++k) {
      if (field->cpp_type() == Field::CPPTYPE_STRING && field->type() == Field::TYPE_STRING) {
        if (field->is_repeated())
          values.AddString(&message, field, hostile);
        else
          values.SetString(&message, field, hostile);
      } else if (field->cpp_type() == Field::CPPTYPE_MESSAGE && depth > 0 && !field->is_map()) {
        fill(field->is_repeated() ? *values.AddMessage(&message, field)
                                  : *values.MutableMessage(&message, field),
             depth - 1);
      }
    }
  }
}

template <class Message>
Message filled() {
  Message message;
  fill(message, 4);
  return message;
}

void expect_harmless(const std::string& text) {
  EXPECT_NE(text.find("FORGED"), std::string::npos) << "nothing of it is shown";
  EXPECT_EQ(words::shown(text, "\n"), text);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    EXPECT_FALSE(line.starts_with("FORGED")) << text;
}

TEST(HostileText, OfAJobIsHarmless) {
  v1::Job job = filled<v1::Job>();
  job.mutable_spec()->clear_sweep();
  for (const v1::JobStatus::State state :
       {v1::JobStatus::STATE_SUCCEEDED, v1::JobStatus::STATE_FAILED}) {
    job.mutable_status()->set_state(state);
    for (v1::LoadCaseAnswer& answer : *job.mutable_status()->mutable_answers())
      answer.set_status(v1::LoadCaseAnswer::STATUS_CONVERGED);
    expect_harmless(job_text(job));
  }
  job.mutable_spec()->mutable_sweep();
  expect_harmless(job_text(job));
  expect_harmless(expired_text(job));
}

TEST(HostileText, OfAMeshIsHarmless) {
  v1::Mesh mesh = filled<v1::Mesh>();
  mesh.set_triangle_count(7);
  expect_harmless(mesh_text(mesh, {}));
}

TEST(HostileText, InJsonIsHarmlessAndComesBack) {
  const v1::Job job = filled<v1::Job>();
  const std::string text = to_json(job);
  EXPECT_EQ(words::shown(text, "\n"), text);
  v1::Job back;
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(text, &back).ok());
  EXPECT_EQ(back.SerializeAsString(), job.SerializeAsString());
}

}  // namespace
}  // namespace anticrack::cli
