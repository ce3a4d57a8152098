// SPDX-License-Identifier: GPL-3.0-or-later
//
// The server's exception. The message gives the bad value and the cure; rpc/error_table.cpp maps
// the reason to a gRPC code.
#pragma once

#include <fmt/core.h>

#include <chrono>
#include <exception>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace anticrack::errors {

/// The kind of an error, as far as callers can react to it.
enum class Reason {
  invalid_argument,     ///< a value that is never accepted
  case_invalid,         ///< a case with a key or value that is not possible
  geometry_invalid,     ///< the geometry is not a membrane cut by interfaces
  mesh_invalid,         ///< a .msh that cannot be read or is not a cut membrane
  expression_invalid,   ///< syntax error, unknown symbol, or a value that is not finite
  request_id_reused,    ///< the same request id with a different request
  limit_exceeded,       ///< beyond a fixed limit of the server
  not_found,            ///< no such mesh, job or upload
  not_ready,            ///< another state is needed first (not meshed, not ended)
  in_use,               ///< needed by something unfinished
  sequence_trimmed,     ///< these events are no longer, or not yet, in the log
  offset_out_of_range,  ///< beyond the end of a block
  busy,                 ///< a queue or budget is full; retry after retry_delay
  quota_exceeded,       ///< the server keeps no more of them; delete some
  draining,             ///< the server is stopping
  disk_full,            ///< no space, or the disk budget is used up; retry after retry_delay
  result_expired,       ///< the result was removed (age or disk budget)
  timed_out,            ///< a job waited or ran too long
  unauthenticated,      ///< unknown caller
  permission_denied,    ///< for administrators only
  not_implemented,      ///< part of the API, but not of this version
  cancelled,            ///< stopped on request
  mesher_failed,        ///< the helper crashed, timed out or ran out of memory
  numerical,            ///< a factorisation or iteration failed (e.g. a floating subdomain)
  storage,              ///< the disk failed
  internal,             ///< a bug
};

/// Stable upper-case name of a reason, e.g. "EXPRESSION_INVALID".
std::string_view name(Reason reason) noexcept;

/// A number, and a place in the plane as "(x, y)", for messages: with eight significant digits.
std::string shown(double value);
std::string shown(double x, double y);

/// A field of the request, and its fault.
struct FieldViolation {
  std::string field;  ///< path, e.g. "load_cases[1].force.expression"
  std::string description;
};

/// An error with all details for the client. Copyable, as jobs and meshes keep their errors. Copies
/// have their own messages; those of std::runtime_error are shared between threads.
class Error : public std::exception {
 public:
  Error(Reason reason, std::string message) : _reason(reason), _message(std::move(message)) {}
  /// With the message that fmt::format() makes of the rest.
  template <class First, class... Rest>
  Error(Reason reason, fmt::format_string<First, Rest...> message, First&& first, Rest&&... rest)
      : Error(reason,
              fmt::format(message, std::forward<First>(first), std::forward<Rest>(rest)...)) {}

  const char* what() const noexcept override { return _message.c_str(); }

  /// Adds the field at fault; the message is its description.
  Error& at(std::string field);
  Error& with(std::string key, std::string value);
  Error& retry_after(std::chrono::milliseconds delay);
  /// Replaces the path of every field by rename(path).
  template <class Rename>
  Error& rename(const Rename& rename) {
    for (FieldViolation& violation : _fields) violation.field = rename(violation.field);
    return *this;
  }
  /// Prepends "prefix." to the path of every field, for the layer above; an empty path becomes
  /// "prefix".
  Error& below(std::string_view prefix);

  Reason reason() const noexcept { return _reason; }
  const std::vector<FieldViolation>& fields() const noexcept { return _fields; }
  const std::map<std::string, std::string>& metadata() const noexcept { return _metadata; }
  std::chrono::milliseconds retry_delay() const noexcept { return _retry_delay; }

 private:
  Reason _reason;
  std::string _message;
  std::vector<FieldViolation> _fields;
  std::map<std::string, std::string> _metadata;
  std::chrono::milliseconds _retry_delay{0};
};

}  // namespace anticrack::errors
