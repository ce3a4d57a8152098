// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>

namespace anticrack::rpc {

/// The source of a server stream's messages; it knows no transport. One thread at a time calls it.
/// Every method may throw errors::Error, with which the stream then ends.
template <class Response>
class Feed {
 public:
  enum class Next {
    message,  ///< `response` is filled
    wait,     ///< nothing to send now; ask again after a wake
    end,      ///< all was sent
  };

  Feed() = default;
  Feed(const Feed&) = delete;
  Feed& operator=(const Feed&) = delete;
  virtual ~Feed() = default;

  /// Begins. The feed may call `wake` from any thread until it is destroyed.
  virtual void start(std::function<void()> /*wake*/) {}
  /// Fills `response`, which is empty, with the next message.
  virtual Next next(Response& response) = 0;
  /// Whether all that will ever be sent is there already; a server that stops then lets it be read.
  virtual bool ending() const noexcept { return false; }
  /// The number of events that were not sent yet. May be called from any thread.
  virtual std::uint64_t lag() const noexcept { return 0; }
  /// Called when nothing was sent for a while; true if `response` was filled with a sign of life.
  virtual bool heartbeat(Response& /*response*/) { return false; }
};

}  // namespace anticrack::rpc
