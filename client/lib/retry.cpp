// SPDX-License-Identifier: GPL-3.0-or-later
#include "client/retry.hpp"

#include <algorithm>
#include <string_view>

namespace anticrack::client {

bool is_lost_connection(const Error& error) {
  const std::string_view message = error.what();
  switch (error.code()) {
    case Code::unavailable:
      return true;
    case Code::cancelled:  // by a server that stops, not on our request
      return error.details().reason.empty();
    case Code::unknown:
      return message.find("Stream removed") != std::string_view::npos;
    case Code::internal:
      return message.find("RST_STREAM") != std::string_view::npos;
    default:
      return false;
  }
}

bool may_retry(const Error& error) {
  return is_lost_connection(error) ||
         (error.code() == Code::resource_exhausted && error.details().retry_delay.count() > 0);
}

Backoff::Backoff(RetryPolicy policy, std::uint32_t seed)
    : _policy(policy), _delay(policy.first), _random(seed) {}

std::optional<std::chrono::milliseconds> Backoff::next(const Error& error,
                                                       std::chrono::milliseconds failing,
                                                       std::chrono::milliseconds patience) {
  if (!may_retry(error)) return std::nullopt;
  std::uniform_int_distribution<std::int64_t> upper_half(_delay.count() / 2, _delay.count());
  const auto delay =
      std::max(std::chrono::milliseconds(upper_half(_random)), error.details().retry_delay);
  _delay = std::min(2 * _delay, _policy.longest);
  if (failing + delay > patience) return std::nullopt;
  return delay;
}

std::string retry_text(const Error& error, const std::string& address,
                       std::chrono::milliseconds patience) {
  if (!is_lost_connection(error)) return std::string(error.what()) + "; trying again";
  constexpr std::int64_t minute = 60'000;
  const std::int64_t time = patience.count();
  const std::string limit = time >= minute && time % minute == 0
                                ? std::to_string(time / minute) + " min"
                                : std::to_string((time + 999) / 1000) + " s";
  const std::string who =
      error.details().reason.empty() ? "server " + address + " gone" : std::string(error.what());
  return who + ", trying again for up to " + limit;
}

}  // namespace anticrack::client
