// SPDX-License-Identifier: GPL-3.0-or-later
//
// Every streaming call that is open: counted, woken, ticked and, when the server stops, ended.
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

/// What the hub's thread wakes.
class Wakeable {
 public:
  Wakeable() = default;
  Wakeable(const Wakeable&) = delete;
  Wakeable& operator=(const Wakeable&) = delete;
  virtual ~Wakeable() = default;

  /// There may be something to send. On the hub's thread; does not block.
  virtual void wake() noexcept = 0;
  /// Wakes before this time wait for it, and are one.
  virtual SteadyClock::time_point not_before() const noexcept { return {}; }

 private:
  friend class StreamHub;
  std::atomic<bool> _queued{false};
};

/// A streaming call as the hub sees it. Every method may be called from the hub's thread at any
/// time after the stream was added, also after the call ended, and does not block.
class Stream : public Wakeable {
 public:
  /// Time passed: send a heartbeat, give up on a peer that stalls.
  virtual void tick(SteadyClock::time_point now) noexcept = 0;
  /// Finish the call with this error as soon as the transport allows it; what is about to end by
  /// itself (Feed::ending) may do so.
  virtual void end(const errors::Error& error) noexcept = 0;
  /// Break the call off without waiting for the peer.
  virtual void abort() noexcept = 0;
  /// How many events its peer is behind.
  virtual std::uint64_t lag() const noexcept { return 0; }
};

enum class StreamKind { watch, transfer };

struct StreamLimits {
  int watchers = 0;
  int transfers = 0;
  int a_client = 0;                             ///< of both together, for one client
  std::chrono::milliseconds heartbeat{10'000};  ///< silence after which a watch is sent one
  std::chrono::milliseconds stall{60'000};      ///< a write or read pending this long ends the call
};

struct StreamCounts {
  int watchers = 0;
  int transfers = 0;
};

/// One thread for all streams: it carries wakes away from the threads that solve, so that these
/// never do a transport's work, and ticks.
/// Lock order: hub before stream; a stream calls the hub with no lock held.
/// Thread-safe. Outlives its streams' calls.
class StreamHub {
 public:
  /// Starts the thread.
  explicit StreamHub(StreamLimits limits);
  ~StreamHub();

  /// `client` as client_of() names it. Throws errors::Error: busy (too many of this kind, or of
  /// this client, whose transfers leave room for others': access/share.hpp), draining. gRPC's own
  /// limit on streams would make calls wait instead.
  void add(StreamKind kind, const std::string& client, const std::shared_ptr<Stream>& stream);
  void remove(const Stream& stream) noexcept;

  /// Has the target woken on the hub's thread; many calls before that are one. Quick.
  void wake(const std::weak_ptr<Wakeable>& target);
  /// The same for a target that may not want to wait any longer for its time. Quick.
  void hurry(const std::weak_ptr<Wakeable>& target);

  /// Refuses new streams from now on.
  void close();
  /// Ends every stream with `error`, breaks off what is still there after `patience`, and returns
  /// when none is left or at `deadline`.
  void drain(const errors::Error& error, std::chrono::milliseconds patience,
             SteadyClock::time_point deadline);

  /// What is open now.
  StreamCounts counts() const;
  /// Of the watcher that is furthest behind. O(watchers).
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
    int transfers = 0;  ///< of these
  };
  std::unordered_map<std::string, Open> _clients;
  bool _closed = false;
  bool _hurry = false;
  bool _stopping = false;
  std::thread _thread;
};

/// Told to a client that reaches a server on its way out.
errors::Error draining_error();

}  // namespace anticrack::rpc
