// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/record_parts.hpp"

#include <limits>
#include <stdexcept>

namespace anticrack::store::disk {

using errors::Reason;

errors::Error damaged_record(const std::string& what) {
  return {Reason::storage, "a record in the database is damaged (" + what +
                               "): restore the data folder from a backup"};
}

namespace {

/// By name, since the enum's numbers change when a reason is added.
Reason reason_of(const std::string& name) {
  for (int i = 0; i <= static_cast<int>(Reason::internal); ++i) {
    if (errors::name(static_cast<Reason>(i)) == name) {
      return static_cast<Reason>(i);
    }
  }
  return Reason::internal;
}

}  // namespace

void write(const errors::Error& error, Error& out) {
  out.set_reason(std::string(errors::name(error.reason())));
  out.set_message(error.what());
  for (const errors::FieldViolation& violation : error.fields()) {
    out.add_fields(violation.field);  // its description is the message
  }
  for (const auto& [key, value] : error.metadata()) {
    Text& text = *out.add_metadata();
    text.set_key(key);
    text.set_value(value);
  }
  out.set_retry_ms(error.retry_delay().count());
}

errors::Error read(const Error& in) {
  errors::Error error(reason_of(in.reason()), in.message());
  for (const std::string& field : in.fields()) {
    error.at(field);
  }
  for (const Text& text : in.metadata()) {
    error.with(text.key(), text.value());
  }
  error.retry_after(std::chrono::milliseconds(in.retry_ms()));
  return error;
}

void write(const std::map<std::string, double>& values, NamedValues& out) {
  for (const auto& [name, value] : values) {
    NamedValue& item = *out.Add();
    item.set_name(name);
    item.set_value(value);
  }
}

std::map<std::string, double> read(const NamedValues& in) {
  std::map<std::string, double> values;
  for (const NamedValue& item : in) {
    values[item.name()] = item.value();
  }
  return values;
}

std::string serialized(const google::protobuf::MessageLite& message) {
  std::string bytes;
  if (message.ByteSizeLong() > std::size_t{std::numeric_limits<int>::max()} ||
      !message.SerializeToString(&bytes)) {
    throw std::length_error("a record is larger than 2 GB");
  }
  return bytes;
}

void parse(std::string_view bytes, google::protobuf::MessageLite& message) {
  if (bytes.size() > std::size_t{std::numeric_limits<int>::max()} ||
      !message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
    throw damaged_record("it cannot be parsed");
  }
}

}  // namespace anticrack::store::disk
