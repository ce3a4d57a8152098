// SPDX-License-Identifier: GPL-3.0-or-later
//
// Decides whether a failed call is tried again, and after how long. One policy serves all calls,
// since all can be repeated: CreateJob has its request id, meshes and uploads are named by their
// content, a watch goes on after a number, a read at an offset; cancelling, warming and evicting
// twice has the effect of doing it once; a repeated delete says NOT_FOUND. Pure: the caller sleeps.
//
//   UNAVAILABLE                              lost: a killed or draining server reached directly
//   UNKNOWN "Stream removed"                 lost: the same behind haproxy
//   INTERNAL "RST_STREAM"                    lost: the same behind nginx
//   RESOURCE_EXHAUSTED with a retry delay    refused for now: not before that delay
//   anything else                            stands
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <random>
#include <string>

#include "error.hpp"

namespace anticrack::client {

/// Whether the connection was lost, and the call was not refused.
bool is_lost_connection(const Error& error);

/// is_lost_connection, or a refusal with a delay after which to try again (queue full).
bool may_retry(const Error& error);

struct RetryPolicy {
  std::chrono::milliseconds first{100};         ///< delay before the second try
  std::chrono::milliseconds longest{1'000};     ///< bound of the doubling delay
  std::chrono::milliseconds patience{300'000};  ///< give up after failing for longer than this
};

/// Delays that double, each drawn from its upper half, so that many clients do not return at once.
class Backoff {
 public:
  /// `seed`: of the random draw; tests give it.
  explicit Backoff(RetryPolicy policy, std::uint32_t seed = std::random_device{}());

  /// The delay before the next try, after calls failed for `failing`, last with `error`; empty:
  /// give up, since the try would come after more than `patience`.
  std::optional<std::chrono::milliseconds> next(const Error& error,
                                                std::chrono::milliseconds failing,
                                                std::chrono::milliseconds patience);
  /// To be called after a successful try.
  void reset() noexcept { _delay = _policy.first; }

 private:
  RetryPolicy _policy;
  std::chrono::milliseconds _delay;
  std::minstd_rand _random;
};

/// The message before a wait; its text is the same as long as the cause is.
std::string retry_text(const Error& error, const std::string& address,
                       std::chrono::milliseconds patience);

}  // namespace anticrack::client
