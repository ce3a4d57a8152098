// SPDX-License-Identifier: GPL-3.0-or-later
//
// The one place where the domain's errors become gRPC's.
#pragma once

#include <grpcpp/support/status.h>

#include <cstddef>
#include <string_view>

#include "anticrack/v1/error.pb.h"
#include "errors/errors.hpp"

namespace anticrack::rpc {

/// Serialised details stay below this: at 9 kB gRPC replaced the whole error by one of its own.
/// The metadata carries the message a second time and the details in base64, hence the margin.
constexpr std::size_t max_detail_bytes = 3072;

/// As BadRequest says in error.proto.
constexpr std::size_t max_violations = 20;

/// What a call fails with that fails by a reason.
grpc::StatusCode code(errors::Reason reason) noexcept;

/// The error as a client reads it: code, message, ErrorInfo, and BadRequest and RetryInfo where the
/// error has fields or a delay. Never larger than max_detail_bytes: texts are cut first, then
/// violations and metadata left out.
v1::Status to_message(const errors::Error& error);

/// The same as the status of a call.
grpc::Status to_status(const errors::Error& error);

/// Status of the exception being handled: an errors::Error as it is, memory running out as `busy`,
/// anything else as `internal`, logged with `where` and not shown to the client.
errors::Error current_error(std::string_view where);

}  // namespace anticrack::rpc
