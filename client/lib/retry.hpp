// SPDX-License-Identifier: GPL-3.0-or-later
//
// When a failed call is tried again, and after how long. Pure: the caller sleeps.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <random>

#include "client/error.hpp"

namespace anticrack::client {

/// Whether the connection was lost rather than the call refused. A killed server is UNAVAILABLE
/// when reached directly, UNKNOWN "Stream removed" behind haproxy, INTERNAL "RST_STREAM" behind
/// nginx.
bool is_lost_connection(const Error& error);

/// is_lost_connection, or a refusal that names a delay after which to try again (queue full).
bool may_retry(const Error& error);

struct RetryPolicy {
  std::chrono::milliseconds first{100};        ///< delay before the second try
  std::chrono::milliseconds longest{3'000};    ///< bound of the doubling delay
  std::chrono::milliseconds patience{60'000};  ///< give up when failing for longer than this
};

/// Delays that double, each drawn from its upper half so that many clients do not return at once.
class Backoff {
 public:
  explicit Backoff(RetryPolicy policy, std::uint32_t seed = std::random_device{}());

  /// Delay before the next try, after having failed for `failing` with `error`; empty: give up.
  std::optional<std::chrono::milliseconds> next(const Error& error,
                                                std::chrono::milliseconds failing);
  /// A try went well.
  void reset() noexcept { _delay = _policy.first; }

 private:
  RetryPolicy _policy;
  std::chrono::milliseconds _delay;
  std::minstd_rand _random;
};

}  // namespace anticrack::client
