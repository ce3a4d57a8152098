// SPDX-License-Identifier: GPL-3.0-or-later
//
// Errors as messages: text, reason, fields, metadata and retry delay. What number a gRPC call fails
// with (Status.code) is the server's to say: rpc/error_table.hpp.
#pragma once

#include <cstddef>
#include <limits>

#include "anticrack/v1/error.pb.h"
#include "errors/errors.hpp"

namespace anticrack::api {

/// How much is told: bytes of texts, entries of lists. By default all of it.
struct Budget {
  static constexpr std::size_t all = std::numeric_limits<std::size_t>::max();
  std::size_t message = all;
  std::size_t description = all;
  std::size_t field = all;
  std::size_t violations = all;
  std::size_t metadata = all;
  std::size_t value = all;
};

/// Message, ErrorInfo, and BadRequest and RetryInfo where the error has fields or a delay. Control
/// characters and bytes that are not UTF-8 become '?'.
v1::Status to_message(const errors::Error& error, const Budget& budget = {});

}  // namespace anticrack::api
