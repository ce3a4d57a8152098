// SPDX-License-Identifier: GPL-3.0-or-later
//
// The only place that turns the domain's errors into those of gRPC.
#pragma once

#include <grpcpp/support/status.h>

#include <cstddef>
#include <string_view>

#include "anticrack/v1/error.pb.h"
#include "errors/errors.hpp"

namespace anticrack::rpc {

/// Serialised details stay below this, since at 9 kB gRPC replaced the whole error by one of its
/// own. The margin is needed because the metadata has the message a second time and the details in
/// base64.
constexpr std::size_t max_detail_bytes = 3072;

/// Most violations, as BadRequest in error.proto says.
constexpr std::size_t max_violations = 20;

/// The status code of a call that fails for a reason.
grpc::StatusCode code(errors::Reason reason) noexcept;

/// The error as a client reads it: code, message, ErrorInfo, and BadRequest and RetryInfo if the
/// error has fields or a delay. Never larger than max_detail_bytes: first texts are cut, then
/// violations and metadata are left out.
v1::Status to_message(const errors::Error& error);

/// The same as the status of a call.
grpc::Status to_status(const errors::Error& error);

/// The exception being handled, as an error: an errors::Error as it is, missing memory as `busy`,
/// anything else as `internal`, which is logged with `where` and not shown to the client.
errors::Error current_error(std::string_view where);

}  // namespace anticrack::rpc
