// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a failed call says, as a client reads it.
#pragma once

#include <grpcpp/grpcpp.h>

#include <map>
#include <string>
#include <vector>

namespace anticrack::testing {

struct Details {
  std::string reason;
  std::map<std::string, std::string> metadata;
  std::vector<std::string> fields;
  std::vector<std::string> descriptions;
  double retry_seconds = 0;
};

/// Reads them back; a gtest failure where they are not those error.proto promises: a Status with
/// the code and message of the call, ErrorInfo always, below 4 KiB.
Details details_of(const grpc::Status& status);

/// gtest failure unless the call failed with this code, reason and (where not empty) field.
void expect_error(const grpc::Status& status, grpc::StatusCode code, const std::string& reason,
                  const std::string& field);

}  // namespace anticrack::testing
