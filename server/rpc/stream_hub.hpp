// SPDX-License-Identifier: GPL-3.0-or-later
//
// Counts, wakes and ticks all open streaming calls, and ends them when the server stops.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "errors/errors.hpp"

namespace anticrack::rpc {

using SteadyClock = std::chrono::steady_clock;

/// A target that the hub's thread wakes.
class Wakeable {
 public:
  Wakeable() = default;
  Wakeable(const Wakeable&) = delete;
  Wakeable& operator=(const Wakeable&) = delete;
  virtual ~Wakeable() = default;

  /// Called when there may be something to send, on the hub's thread; must not block.
  virtual void wake() noexcept = 0;
  /// Wakes before this time wait for it, and become one.
  virtual SteadyClock::time_point not_before() const noexcept { return {}; }

 private:
  friend class StreamHub;
  std::atomic<bool> _queued{false};
};

/// A streaming call as the hub sees it. The hub's thread may call every method at any time after
/// the stream was added, also after the call has ended. No method may block.
class Stream : public Wakeable {
 public:
  /// Called from time to time: sends a heartbeat, or gives up on a peer that stalls.
  virtual void tick(SteadyClock::time_point now) noexcept = 0;
  /// Finishes the call with this error as soon as the transport allows it; a call that is about to
  /// end by itself (Feed::ending) may do so.
  virtual void end(const errors::Error& error) noexcept = 0;
  /// Breaks the call off without waiting for the peer.
  virtual void abort() noexcept = 0;
  /// By how many events its peer is behind.
  virtual std::uint64_t lag() const noexcept { return 0; }
};

enum class StreamKind { watch, transfer };

struct StreamLimits {
  int watchers = 0;
  int transfers = 0;
  int a_client = 0;                             ///< watches and transfers together, for one client
  std::chrono::milliseconds heartbeat{10'000};  ///< silence after which a watch is sent one
  std::chrono::milliseconds stall{60'000};      ///< a write or read pending this long ends the call
};

struct StreamCounts {
  int watchers = 0;
  int transfers = 0;
};

/// Has one thread for all streams, which ticks them and takes over wakes from the threads that
/// solve, so that these never do a transport's work. Lock order: hub before stream; a stream calls
/// the hub with no lock held. Thread-safe. Outlives its streams' calls.
class StreamHub {
 public:
  /// Starts the thread.
  explicit StreamHub(StreamLimits limits);
  ~StreamHub();

  /// Adds a stream. `client`: as client_of() names it. Throws errors::Error: busy (too many of this
  /// kind or of this client; transfers of a client must leave room for others, see
  /// access/share.hpp), draining. gRPC's own limit on streams would make calls wait instead.
  void add(StreamKind kind, const std::string& client, const std::shared_ptr<Stream>& stream);
  void remove(const Stream& stream) noexcept;

  /// Has the hub's thread wake the target; several calls before that count as one. Quick.
  void wake(const std::weak_ptr<Wakeable>& target);
  /// The same for a target whose not_before() may have moved to an earlier time. Quick.
  void hurry(const std::weak_ptr<Wakeable>& target);

  /// Refuses new streams from now on.
  void close();
  /// Ends every stream with `error`, breaks off those that are left after `patience`, and returns
  /// when none is left, or at `deadline`.
  void drain(const errors::Error& error, std::chrono::milliseconds patience,
             SteadyClock::time_point deadline);

  /// The numbers of streams that are open now.
  StreamCounts counts() const;
  /// The lag of the watcher that is furthest behind. O(watchers).
  std::uint64_t largest_lag() const;
  const StreamLimits& limits() const noexcept { return _limits; }

 private:
  struct Entry {
    StreamKind kind;
    std::string client;
    std::weak_ptr<Stream> stream;
  };

  void run();
  int& count_of(StreamKind kind) {
    return kind == StreamKind::watch ? _counts.watchers : _counts.transfers;
  }
  std::vector<std::shared_ptr<Stream>> streams() const;
  bool wait_until_empty(SteadyClock::time_point deadline);

  const StreamLimits _limits;
  mutable std::mutex _mutex;
  std::condition_variable _changed;
  std::unordered_map<const Stream*, Entry> _entries;
  std::vector<std::weak_ptr<Wakeable>> _woken;
  StreamCounts _counts;
  struct Open {
    int streams = 0;
    int transfers = 0;  ///< open transfers
  };
  std::unordered_map<std::string, Open> _clients;
  bool _closed = false;
  bool _hurry = false;
  bool _stopping = false;
  std::thread _thread;
};

/// The error for a client that calls a server that is stopping.
errors::Error draining_error();

}  // namespace anticrack::rpc
