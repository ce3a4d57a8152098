// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>

namespace anticrack::rpc {

/// What a server stream sends, message by message; knows no transport. Called by one thread at a
/// time. Every method may throw errors::Error: the stream ends with it.
template <class Response>
class Feed {
 public:
  enum class Next {
    message,  ///< `response` is filled
    wait,     ///< nothing now; ask again after a wake
    end,      ///< all was sent
  };

  Feed() = default;
  Feed(const Feed&) = delete;
  Feed& operator=(const Feed&) = delete;
  virtual ~Feed() = default;

  /// `wake` may be called from any thread until the feed is destroyed.
  virtual void start(std::function<void()> /*wake*/) {}
  /// `response` is clear.
  virtual Next next(Response& response) = 0;
  /// True when all that will ever be sent is there already: a server that stops lets it be read.
  virtual bool ending() const noexcept { return false; }
  /// Events there are and were not sent yet. From any thread.
  virtual std::uint64_t lag() const noexcept { return 0; }
  /// Nothing was sent for a while: true when `response` was filled with a sign of life.
  virtual bool heartbeat(Response& /*response*/) { return false; }
};

}  // namespace anticrack::rpc
