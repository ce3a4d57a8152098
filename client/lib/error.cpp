// SPDX-License-Identifier: GPL-3.0-or-later
#include "client/error.hpp"

#include <algorithm>
#include <utility>

#include "anticrack/v1/error.pb.h"

namespace anticrack::client {
namespace {

constexpr int largest_code = 16;

Code to_code(int code) {
  return code >= 0 && code <= largest_code ? static_cast<Code>(code) : Code::unknown;
}

// Compares type names: details have those of google.rpc, with the same fields as our messages.
bool is(const google::protobuf::Any& detail, std::string_view type) {
  const std::string& url = detail.type_url();
  const std::size_t slash = url.rfind('/');
  return slash != std::string::npos && std::string_view(url).substr(slash + 1) == type;
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
    if (is(detail, "google.rpc.ErrorInfo")) {
      v1::ErrorInfo info;
      if (info.ParseFromString(detail.value())) {
        details.reason = info.reason();
        details.metadata.insert(info.metadata().begin(), info.metadata().end());
      }
    } else if (is(detail, "google.rpc.BadRequest")) {
      v1::BadRequest request;
      if (request.ParseFromString(detail.value()))
        for (const auto& violation : request.field_violations())
          details.fields.push_back({violation.field(), violation.description()});
    } else if (is(detail, "google.rpc.RetryInfo")) {
      v1::RetryInfo retry;
      if (retry.ParseFromString(detail.value()))
        details.retry_delay = to_milliseconds(retry.retry_delay());
    }
  }
  return details;
}

}  // namespace

std::string_view name(Code code) noexcept {
  switch (code) {
    case Code::ok:
      return "OK";
    case Code::cancelled:
      return "CANCELLED";
    case Code::unknown:
      return "UNKNOWN";
    case Code::invalid_argument:
      return "INVALID_ARGUMENT";
    case Code::deadline_exceeded:
      return "DEADLINE_EXCEEDED";
    case Code::not_found:
      return "NOT_FOUND";
    case Code::already_exists:
      return "ALREADY_EXISTS";
    case Code::permission_denied:
      return "PERMISSION_DENIED";
    case Code::resource_exhausted:
      return "RESOURCE_EXHAUSTED";
    case Code::failed_precondition:
      return "FAILED_PRECONDITION";
    case Code::aborted:
      return "ABORTED";
    case Code::out_of_range:
      return "OUT_OF_RANGE";
    case Code::unimplemented:
      return "UNIMPLEMENTED";
    case Code::internal:
      return "INTERNAL";
    case Code::unavailable:
      return "UNAVAILABLE";
    case Code::data_loss:
      return "DATA_LOSS";
    case Code::unauthenticated:
      return "UNAUTHENTICATED";
  }
  return "UNKNOWN";
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
