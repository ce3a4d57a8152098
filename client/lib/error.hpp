// SPDX-License-Identifier: GPL-3.0-or-later
//
// The exception of a failed call: the server's error, decoded. Without gRPC types.
#pragma once

#include <chrono>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace anticrack::v1 {
class Status;
}

namespace anticrack::client {

/// gRPC's status codes, by their numbers on the wire.
enum class Code {
  ok = 0,
  cancelled = 1,
  unknown = 2,
  invalid_argument = 3,
  deadline_exceeded = 4,
  not_found = 5,
  already_exists = 6,
  permission_denied = 7,
  resource_exhausted = 8,
  failed_precondition = 9,
  aborted = 10,
  out_of_range = 11,
  unimplemented = 12,
  internal = 13,
  unavailable = 14,
  data_loss = 15,
  unauthenticated = 16,
};

/// The name of a code, like "INVALID_ARGUMENT"; "UNKNOWN" for a number that is no code.
std::string_view name(Code code) noexcept;

struct FieldViolation {
  std::string field;  ///< path in the request, e.g. "spec.load_cases[1].force.expression"
  std::string description;
};

/// What the server adds to a code and a message; members are empty if it adds nothing.
struct Details {
  std::string reason;  ///< stable, UPPER_SNAKE_CASE
  std::map<std::string, std::string> metadata;
  std::vector<FieldViolation> fields;
  std::chrono::milliseconds retry_delay{0};  ///< wait at least this long before the next try
};

class Error : public std::runtime_error {
 public:
  Error(Code code, const std::string& message, Details details = {})
      : std::runtime_error(message), _code(code), _details(std::move(details)) {}

  Code code() const noexcept { return _code; }
  const Details& details() const noexcept { return _details; }

 private:
  Code _code;
  Details _details;
};

/// Thrown when a stop token ended the call.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// The error of a status. `details_bin`: the trailing metadata "grpc-status-details-bin", possibly
/// empty. Details that cannot be decoded are ignored; code and message remain.
Error decode_error(int code, const std::string& message, std::string_view details_bin);

/// The error inside a job, a load case or a mesh.
Error decode_error(const v1::Status& status);

}  // namespace anticrack::client
