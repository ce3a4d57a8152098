// SPDX-License-Identifier: GPL-3.0-or-later
//
// Errors as messages: text, reason, fields, metadata and retry delay. rpc/error_table.hpp sets
// Status.code.
#pragma once

#include <cstddef>
#include <limits>

#include "anticrack/v1/error.pb.h"
#include "errors/errors.hpp"

namespace anticrack::api {

/// Limits of the message: bytes of texts, entries of lists. By default none.
struct Budget {
  static constexpr std::size_t all = std::numeric_limits<std::size_t>::max();
  std::size_t message = all;
  std::size_t description = all;
  std::size_t field = all;
  std::size_t violations = all;
  std::size_t metadata = all;
  std::size_t value = all;
};

/// The error as a message with ErrorInfo, and BadRequest and RetryInfo if it has fields or a delay.
/// Control characters and invalid UTF-8 become '?'.
v1::Status to_message(const errors::Error& error, const Budget& budget = {});

}  // namespace anticrack::api
