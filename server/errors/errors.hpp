// SPDX-License-Identifier: GPL-3.0-or-later
//
// The one exception of the server. A layer that knows what is wrong throws it with the bad value
// and the cure in the message; rpc/error_table.cpp maps its reason to a gRPC code.
#pragma once

#include <chrono>
#include <exception>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace anticrack::errors {

/// What went wrong, as far as a caller would act differently on it.
enum class Reason {
  invalid_argument,     ///< a value no state of the server could accept
  geometry_invalid,     ///< geometry that describes no membrane cut by an interface
  mesh_invalid,         ///< a .msh that cannot be read, or is not a cut membrane
  expression_invalid,   ///< syntax error, unknown symbol, or a value that is not finite
  request_id_reused,    ///< same request id, other body
  limit_exceeded,       ///< larger than a bound of the server could ever allow
  not_found,            ///< no such mesh, job or upload
  not_ready,            ///< needs another state first (not meshed, not ended)
  in_use,               ///< held by something that has not ended
  sequence_trimmed,     ///< events asked for are no longer, or not yet, in the log
  offset_out_of_range,  ///< past the end of a block
  busy,                 ///< a queue or budget is full now; try again after retry_delay
  draining,             ///< the server is stopping
  disk_full,            ///< no space, or the disk budget is spent; try again after retry_delay
  result_expired,       ///< the result was removed by age or by the disk budget
  timed_out,            ///< a job waited or ran longer than it may
  unauthenticated,      ///< nobody this server knows
  permission_denied,    ///< known, but only an administrator may
  not_implemented,      ///< in the API, not in this version
  cancelled,            ///< asked to stop
  mesher_failed,        ///< the helper crashed, timed out or ran out of memory
  numerical,            ///< factorisation or iteration broke down (e.g. a floating subdomain)
  storage,              ///< the disk refused
  internal,             ///< a bug
};

/// Stable upper-case name of a reason, e.g. "EXPRESSION_INVALID".
std::string_view name(Reason reason) noexcept;

/// A field of the request and what is wrong with it.
struct FieldViolation {
  std::string field;  ///< path, e.g. "load_cases[1].force.expression"
  std::string description;
};

/// Error with everything a client is told. Copyable, so it can also be kept in a job or mesh. It
/// holds its own message: copies of std::runtime_error share one among threads.
class Error : public std::exception {
 public:
  Error(Reason reason, std::string message) : _reason(reason), _message(std::move(message)) {}

  const char* what() const noexcept override { return _message.c_str(); }

  /// Adds the field at fault; the message is its description.
  Error& at(std::string field);
  Error& with(std::string key, std::string value);
  Error& retry_after(std::chrono::milliseconds delay);
  /// Puts `prefix` before the path of every field, as the error climbs to the layer that knows
  /// where the part stands in the request.
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
