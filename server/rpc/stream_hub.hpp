// SPDX-License-Identifier: GPL-3.0-or-later
//
// Every streaming call that is open: counted, woken, ticked and, when the server stops, ended.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <unordered_map>

#include "errors/errors.hpp"

namespace anticrack::rpc {

using SteadyClock = std::chrono::steady_clock;

/// A streaming call as the hub sees it. Every method may be called from the hub's thread at any
/// time after the stream was added, also after the call ended, and does not block.
class Stream {
 public:
  Stream() = default;
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  virtual ~Stream() = default;

  /// There may be something to send.
  virtual void wake() noexcept = 0;
  /// Time passed: send a heartbeat, give up on a peer that stalls.
  virtual void tick(SteadyClock::time_point now) noexcept = 0;
  /// Finish the call with this error as soon as the transport allows it; what is about to end by
  /// itself (Feed::ending) may do so.
  virtual void end(const errors::Error& error) noexcept = 0;
  /// Break the call off without waiting for the peer.
  virtual void abort() noexcept = 0;

 private:
  friend class StreamHub;
  std::atomic<bool> _queued{false};
};

enum class StreamKind { watch, transfer };

struct StreamLimits {
  int watchers = 0;
  int transfers = 0;
  std::chrono::milliseconds heartbeat{10'000};  ///< silence after which a watch is sent one
  std::chrono::milliseconds stall{60'000};      ///< a write or read pending this long ends the call
};

/// One thread for all streams: it carries wakes away from the threads that solve, so that these
/// never do a transport's work, and ticks.
/// Lock order: hub before stream; a stream calls the hub with no lock held.
/// Thread-safe. Outlives its streams' calls.
class StreamHub {
 public:
  explicit StreamHub(StreamLimits limits);
  ~StreamHub();

  /// Throws errors::Error: busy (too many of this kind), draining.
  void add(StreamKind kind, const std::shared_ptr<Stream>& stream);
  void remove(const Stream& stream) noexcept;

  /// Has the stream woken on the hub's thread; many calls before that are one. Quick.
  void wake(const std::weak_ptr<Stream>& stream);

  /// Refuses new streams from now on.
  void close();
  /// Ends every stream with `error`, breaks off what is still there after `patience`, and returns
  /// when none is left or at `deadline`.
  void drain(const errors::Error& error, std::chrono::milliseconds patience,
             SteadyClock::time_point deadline);

  int watchers() const;
  const StreamLimits& limits() const noexcept { return _limits; }

 private:
  struct Entry {
    StreamKind kind;
    std::weak_ptr<Stream> stream;
  };

  void run();
  std::vector<std::shared_ptr<Stream>> streams() const;
  bool wait_until_empty(SteadyClock::time_point deadline);

  const StreamLimits _limits;
  mutable std::mutex _mutex;
  std::condition_variable _changed;
  std::unordered_map<const Stream*, Entry> _entries;
  std::deque<std::weak_ptr<Stream>> _woken;
  int _watchers = 0;
  int _transfers = 0;
  bool _closed = false;
  bool _stopping = false;
  std::thread _thread;
};

/// Told to a client that reaches a server on its way out.
errors::Error draining_error();

}  // namespace anticrack::rpc
