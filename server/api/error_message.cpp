// SPDX-License-Identifier: GPL-3.0-or-later
#include "api/error_message.hpp"

#include <algorithm>
#include <string>

#include "api/translations.hpp"
#include "words/shown.hpp"

namespace anticrack::api {

using errors::Error;
using errors::Reason;

namespace {

/// Packs a detail as google.rpc does; the messages are wire-compatible.
template <class Detail>
std::string type_url() {
  return "type.googleapis.com/google.rpc." + Detail::descriptor()->name();
}

template <class Detail>
void pack(const Detail& detail, v1::Status& status) {
  google::protobuf::Any& any = *status.add_details();
  any.set_type_url(type_url<Detail>());
  any.set_value(serialized(detail));
}

template <class Detail>
Detail unpacked(const v1::Status& status) {
  Detail detail;
  for (const google::protobuf::Any& any : status.details())
    if (any.type_url() == type_url<Detail>() && !detail.ParseFromString(any.value()))
      throw Error(Reason::invalid_argument, "a detail cannot be parsed").at("details");
  return detail;
}

/// The reason with this name; the numbers of the enum change when a reason is added.
Reason reason_of(const std::string& name) {
  for (int i = 0; i <= static_cast<int>(Reason::internal); ++i)
    if (errors::name(static_cast<Reason>(i)) == name) return static_cast<Reason>(i);
  return Reason::internal;
}

}  // namespace

v1::Status to_message(const Error& error, const Budget& budget) {
  v1::Status status;
  status.set_message(words::printable(error.what(), budget.message));

  v1::ErrorInfo info;
  info.set_reason(std::string(errors::name(error.reason())));
  info.set_domain("anticrack");
  std::size_t kept = 0;
  for (const auto& [key, value] : error.metadata()) {
    if (kept++ == budget.metadata) break;
    (*info.mutable_metadata())[words::printable(key, 64)] = words::printable(value, budget.value);
  }
  pack(info, status);

  if (!error.fields().empty()) {
    v1::BadRequest bad;
    const std::size_t count = std::min(error.fields().size(), budget.violations);
    for (std::size_t i = 0; i < count; ++i) {
      v1::BadRequest::FieldViolation& violation = *bad.add_field_violations();
      violation.set_field(words::printable(error.fields()[i].field, budget.field));
      violation.set_description(
          words::printable(error.fields()[i].description, budget.description));
    }
    pack(bad, status);
  }

  if (error.retry_delay().count() > 0) {
    v1::RetryInfo retry;
    write_field(std::chrono::nanoseconds(error.retry_delay()), retry, "retry_delay");
    pack(retry, status);
  }
  return status;
}

void Translation<Error>::write(const Error& value, v1::Status& to) { to = to_message(value); }

Error Translation<Error>::read(const v1::Status& from) {
  const auto info = unpacked<v1::ErrorInfo>(from);
  Error error(reason_of(info.reason()), from.message());
  const auto bad = unpacked<v1::BadRequest>(from);
  for (const auto& violation : bad.field_violations())
    error.at(violation.field());  // the description is the message itself
  for (const auto& [key, value] : info.metadata()) error.with(key, value);
  const auto delay =
      read_one<std::chrono::nanoseconds>(unpacked<v1::RetryInfo>(from), "retry_delay");
  return error.retry_after(std::chrono::duration_cast<std::chrono::milliseconds>(delay));
}

}  // namespace anticrack::api
