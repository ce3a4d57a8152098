// SPDX-License-Identifier: GPL-3.0-or-later
#include "errors/errors.hpp"

#include <utility>

namespace anticrack::errors {

std::string_view name(Reason reason) noexcept {
  switch (reason) {
    case Reason::invalid_argument:
      return "INVALID_ARGUMENT";
    case Reason::geometry_invalid:
      return "GEOMETRY_INVALID";
    case Reason::mesh_invalid:
      return "MESH_INVALID";
    case Reason::expression_invalid:
      return "EXPRESSION_INVALID";
    case Reason::request_id_reused:
      return "REQUEST_ID_REUSED";
    case Reason::limit_exceeded:
      return "LIMIT_EXCEEDED";
    case Reason::not_found:
      return "NOT_FOUND";
    case Reason::not_ready:
      return "NOT_READY";
    case Reason::in_use:
      return "IN_USE";
    case Reason::sequence_trimmed:
      return "SEQUENCE_TRIMMED";
    case Reason::offset_out_of_range:
      return "OFFSET_OUT_OF_RANGE";
    case Reason::busy:
      return "BUSY";
    case Reason::draining:
      return "DRAINING";
    case Reason::disk_full:
      return "DISK_FULL";
    case Reason::result_expired:
      return "RESULT_EXPIRED";
    case Reason::timed_out:
      return "TIMED_OUT";
    case Reason::unauthenticated:
      return "UNAUTHENTICATED";
    case Reason::permission_denied:
      return "PERMISSION_DENIED";
    case Reason::not_implemented:
      return "NOT_IMPLEMENTED";
    case Reason::cancelled:
      return "CANCELLED";
    case Reason::mesher_failed:
      return "MESHER_FAILED";
    case Reason::numerical:
      return "NUMERICAL";
    case Reason::storage:
      return "STORAGE";
    case Reason::internal:
      return "INTERNAL";
  }
  return "INTERNAL";
}

Error& Error::at(std::string field) {
  _fields.push_back({std::move(field), what()});
  return *this;
}

Error& Error::with(std::string key, std::string value) {
  _metadata[std::move(key)] = std::move(value);
  return *this;
}

Error& Error::retry_after(std::chrono::milliseconds delay) {
  _retry_delay = delay;
  return *this;
}

Error& Error::below(std::string_view prefix) {
  for (FieldViolation& violation : _fields) {
    violation.field.insert(0, ".").insert(0, prefix);
  }
  return *this;
}

}  // namespace anticrack::errors
