// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/error_table.hpp"

#include <algorithm>
#include <array>
#include <new>
#include <string>

#include "api/error_message.hpp"
#include "log/log.hpp"

namespace anticrack::rpc {
namespace {

using errors::Reason;

/// How much of an error to keep; tried in order until it fits.
constexpr std::array<api::Budget, 4> budgets{{
    {800, 300, 200, max_violations, 16, 200},
    {400, 120, 160, 12, 8, 100},
    {300, 80, 120, 5, 8, 60},
    {200, 60, 100, 1, 0, 0},
}};

void log_unexpected(std::string_view where, std::string_view what) {
  log::error("unexpected error", {{"in", std::string(where)}, {"error", std::string(what)}});
}

}  // namespace

grpc::StatusCode code(Reason reason) noexcept {
  switch (reason) {
    case Reason::invalid_argument:
    case Reason::case_invalid:
    case Reason::geometry_invalid:
    case Reason::mesh_invalid:
    case Reason::expression_invalid:
    case Reason::request_id_reused:
    case Reason::limit_exceeded:
      return grpc::StatusCode::INVALID_ARGUMENT;
    case Reason::not_found:
      return grpc::StatusCode::NOT_FOUND;
    case Reason::not_ready:
    case Reason::in_use:
    case Reason::numerical:
    case Reason::result_expired:
      return grpc::StatusCode::FAILED_PRECONDITION;
    case Reason::sequence_trimmed:
    case Reason::offset_out_of_range:
      return grpc::StatusCode::OUT_OF_RANGE;
    case Reason::busy:
    case Reason::quota_exceeded:
    case Reason::storage:
    case Reason::disk_full:
      return grpc::StatusCode::RESOURCE_EXHAUSTED;
    case Reason::timed_out:
      return grpc::StatusCode::DEADLINE_EXCEEDED;
    case Reason::unauthenticated:
      return grpc::StatusCode::UNAUTHENTICATED;
    case Reason::permission_denied:
      return grpc::StatusCode::PERMISSION_DENIED;
    case Reason::draining:
      return grpc::StatusCode::UNAVAILABLE;
    case Reason::not_implemented:
      return grpc::StatusCode::UNIMPLEMENTED;
    case Reason::cancelled:
      return grpc::StatusCode::CANCELLED;
    case Reason::mesher_failed:
    case Reason::internal:
      return grpc::StatusCode::INTERNAL;
  }
  return grpc::StatusCode::INTERNAL;
}

v1::Status to_message(const errors::Error& error) {
  v1::Status status;
  for (const api::Budget& budget : budgets) {
    status = api::to_message(error, budget);
    status.set_code(code(error.reason()));
    if (status.ByteSizeLong() <= max_detail_bytes) break;
  }
  return status;
}

grpc::Status to_status(const errors::Error& error) {
  const v1::Status message = to_message(error);
  return {static_cast<grpc::StatusCode>(message.code()), message.message(),
          message.SerializeAsString()};
}

errors::Error current_error(std::string_view where) {
  try {
    throw;
  } catch (const errors::Error& error) {
    if (error.reason() != Reason::internal) return error;
    log_unexpected(where, error.what());
    return error;
  } catch (const std::bad_alloc&) {
    log_unexpected(where, "out of memory");
    return errors::Error(Reason::busy, "the server is out of memory; try again later")
        .retry_after(std::chrono::seconds(5));
  } catch (const std::exception& error) {
    log_unexpected(where, error.what());
  } catch (...) {
    log_unexpected(where, "an exception of an unknown type");
  }
  return {Reason::internal, "internal error; the server's log says more"};
}

}  // namespace anticrack::rpc
