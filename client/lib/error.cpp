// SPDX-License-Identifier: GPL-3.0-or-later
#include "client/error.hpp"

#include <algorithm>
#include <array>

#include "anticrack/v1/error.pb.h"

namespace anticrack::client {
namespace {

constexpr std::array<std::string_view, 17> code_names{
    "OK",        "CANCELLED",      "UNKNOWN",           "INVALID_ARGUMENT",   "DEADLINE_EXCEEDED",
    "NOT_FOUND", "ALREADY_EXISTS", "PERMISSION_DENIED", "RESOURCE_EXHAUSTED", "FAILED_PRECONDITION",
    "ABORTED",   "OUT_OF_RANGE",   "UNIMPLEMENTED",     "INTERNAL",           "UNAVAILABLE",
    "DATA_LOSS", "UNAUTHENTICATED"};

Code to_code(int code) {
  return code >= 0 && static_cast<std::size_t>(code) < code_names.size() ? static_cast<Code>(code)
                                                                         : Code::unknown;
}

// Reads a detail if it is of this type: those of google.rpc have the same fields as our messages.
template <class Message>
bool reads(const google::protobuf::Any& detail, Message& message) {
  return detail.type_url().ends_with("/google.rpc." + Message::descriptor()->name()) &&
         message.ParseFromString(detail.value());
}

std::chrono::milliseconds to_milliseconds(const google::protobuf::Duration& duration) {
  constexpr std::int64_t day = 24 * 3600;
  const std::int64_t seconds = std::clamp<std::int64_t>(duration.seconds(), 0, day);
  const std::int64_t nanos = std::clamp<std::int64_t>(duration.nanos(), 0, 999'999'999);
  return std::chrono::milliseconds(seconds * 1000 + nanos / 1'000'000);
}

Details decode_details(const v1::Status& status) {
  Details details;
  for (const google::protobuf::Any& detail : status.details()) {
    v1::ErrorInfo info;
    v1::BadRequest request;
    v1::RetryInfo retry;
    if (reads(detail, info)) {
      details.reason = info.reason();
      details.metadata.insert(info.metadata().begin(), info.metadata().end());
    } else if (reads(detail, request)) {
      for (const auto& violation : request.field_violations())
        details.fields.push_back({violation.field(), violation.description()});
    } else if (reads(detail, retry)) {
      details.retry_delay = to_milliseconds(retry.retry_delay());
    }
  }
  return details;
}

}  // namespace

std::string_view name(Code code) noexcept {
  const auto index = static_cast<std::size_t>(code);
  return code_names[index < code_names.size() ? index : static_cast<std::size_t>(Code::unknown)];
}

Error decode_error(int code, const std::string& message, std::string_view details_bin) {
  v1::Status status;
  if (!status.ParseFromArray(details_bin.data(), static_cast<int>(details_bin.size())))
    status.Clear();
  return Error(to_code(code), message, decode_details(status));
}

Error decode_error(const v1::Status& status) {
  return Error(to_code(status.code()), status.message(), decode_details(status));
}

}  // namespace anticrack::client
