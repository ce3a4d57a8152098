// SPDX-License-Identifier: GPL-3.0-or-later
//
// Requests of a newer client: in every message that a request of any method can hold.
#include "api/unknown_fields.hpp"

#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/dynamic_message.h>
#include <google/protobuf/unknown_field_set.h>
#include <grpcpp/generic/generic_stub.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "rpc/details.hpp"
#include "rpc/running_server.hpp"
#include "support/errors.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::error_of;
using anticrack::testing::RunningServer;
using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::MethodDescriptor;

constexpr int unknown_number = 4711;

std::vector<const MethodDescriptor*> methods() {
  std::vector<const MethodDescriptor*> found;
  for (const char* file : {"case", "mesh", "solve", "server"}) {
    const auto* described = google::protobuf::DescriptorPool::generated_pool()->FindFileByName(
        std::string("anticrack/v1/") + file + ".proto");
    for (int s = 0; s < described->service_count(); ++s) {
      for (int m = 0; m < described->service(s)->method_count(); ++m) {
        found.push_back(described->service(s)->method(m));
      }
    }
  }
  return found;
}

std::unique_ptr<Message> make(const Descriptor* type) {
  return std::unique_ptr<Message>(
      google::protobuf::MessageFactory::generated_factory()->GetPrototype(type)->New());
}

Message& part_of(Message& message, const FieldDescriptor* field) {
  const auto* reflection = message.GetReflection();
  return field->is_repeated() ? *reflection->AddMessage(&message, field)
                              : *reflection->MutableMessage(&message, field);
}

std::string path_of(const std::vector<const FieldDescriptor*>& fields) {
  std::string path;
  for (const FieldDescriptor* field : fields) {
    path += (path.empty() ? "" : ".") + field->name() + (field->is_repeated() ? "[0]" : "");
  }
  return path;
}

/// Calls `visit` with every chain of fields that leads to a message in the request, the request
/// included.
void each_message(const Descriptor* type, std::vector<const FieldDescriptor*>& fields,
                  const std::function<void(const Descriptor&)>& visit) {
  visit(*type);
  for (int i = 0; i < type->field_count(); ++i) {
    const FieldDescriptor* field = type->field(i);
    if (field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE || field->is_map()) continue;
    fields.push_back(field);
    each_message(field->message_type(), fields, visit);
    fields.pop_back();
  }
}

/// What require_known says of a request in which `spoil` was done to the message at the end of the
/// chain.
void expect_refused(const Descriptor* request, const std::vector<const FieldDescriptor*>& fields,
                    const std::string& path, const std::function<void(Message&)>& spoil) {
  const std::unique_ptr<Message> message = make(request);
  Message* inner = message.get();
  for (const FieldDescriptor* field : fields) inner = &part_of(*inner, field);
  EXPECT_NO_THROW(api::require_known(*message)) << request->name() << " " << path;
  spoil(*inner);
  const auto error = error_of([&] { api::require_known(*message); });
  ASSERT_TRUE(error) << request->name() << " " << path;
  EXPECT_EQ(error->reason(), errors::Reason::not_implemented);
  if (!path.empty()) {
    EXPECT_EQ(error->fields().at(0).field, path) << request->name();
  }
  EXPECT_THAT(error->what(), ::testing::HasSubstr(std::to_string(unknown_number)));
}

TEST(UnknownFields, OfEveryMessageInEveryRequestAreRefused) {
  int messages = 0, values = 0;
  for (const MethodDescriptor* method : methods()) {
    std::vector<const FieldDescriptor*> fields;
    each_message(method->input_type(), fields, [&](const Descriptor& type) {
      ++messages;
      expect_refused(method->input_type(), fields, path_of(fields), [](Message& inner) {
        inner.GetReflection()->MutableUnknownFields(&inner)->AddVarint(unknown_number, 1);
      });
      for (int i = 0; i < type.field_count(); ++i) {
        const FieldDescriptor* field = type.field(i);
        if (field->cpp_type() != FieldDescriptor::CPPTYPE_ENUM) continue;
        ++values;
        fields.push_back(field);
        const std::string path = path_of(fields);
        fields.pop_back();
        expect_refused(method->input_type(), fields, path, [&](Message& inner) {
          if (field->is_repeated()) {
            inner.GetReflection()->AddEnumValue(&inner, field, unknown_number);
          } else {
            inner.GetReflection()->SetEnumValue(&inner, field, unknown_number);
          }
        });
      }
    });
  }
  EXPECT_GT(messages, 40);
  EXPECT_GT(values, 5);
}

/// Sends `request` to a method of any kind; reads and drops what is answered.
grpc::Status call(RunningServer& server, const MethodDescriptor& method, const Message& request) {
  grpc::GenericStub stub(server.channel());
  grpc::ClientContext context;
  grpc::CompletionQueue queue;
  const auto done = [&] {
    void* tag = nullptr;
    bool ok = false;
    queue.Next(&tag, &ok);
    return ok;
  };
  const auto stream =
      stub.PrepareCall(&context, "/" + method.service()->full_name() + "/" + method.name(), &queue);
  stream->StartCall(nullptr);
  if (done()) {
    const grpc::Slice slice(request.SerializeAsString());
    stream->Write(grpc::ByteBuffer(&slice, 1), nullptr);
    done();
    stream->WritesDone(nullptr);
    done();
  }
  grpc::ByteBuffer answer;
  do {
    stream->Read(&answer, nullptr);
  } while (done());
  grpc::Status status;
  stream->Finish(&status, nullptr);
  done();
  queue.Shutdown();
  return status;
}

TEST(UnknownFields, AreRefusedByEveryMethod) {
  RunningServer server;
  for (const MethodDescriptor* method : methods()) {
    const std::unique_ptr<Message> request = make(method->input_type());
    request->GetReflection()->MutableUnknownFields(request.get())->AddVarint(unknown_number, 1);
    const grpc::Status status = call(server, *method, *request);
    EXPECT_EQ(status.error_code(), grpc::StatusCode::UNIMPLEMENTED) << method->full_name();
    EXPECT_THAT(status.error_message(), ::testing::HasSubstr(std::to_string(unknown_number)))
        << method->full_name();
  }
}

}  // namespace
}  // namespace anticrack::rpc
