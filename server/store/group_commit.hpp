// SPDX-License-Identifier: GPL-3.0-or-later
//
// Changes that come at the same time share one transaction, and so one wait for the disk.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include "errors/errors.hpp"
#include "store/sqlite.hpp"

namespace anticrack::store {

/// A thread that finds no other at work makes its own change and all changes that came meanwhile;
/// the others wait. The lock guards only the queue; the connection belongs to the thread at work.
class GroupCommit {
 public:
  using Change = std::function<void(Connection&)>;
  /// Called by the thread at work after a transaction, once the fate of all transactions before is
  /// settled. It is not settled after a COMMIT that failed while flushing: the log may hold that
  /// transaction whole, and a crash would bring it to life until another transaction has
  /// overwritten it.
  using Settled = std::function<void(Connection&)>;

  GroupCommit(Connection connection, Settled settled)
      : _connection(std::move(connection)), _settled(std::move(settled)) {}

  /// Whether a change must survive a power failure as soon as run() has returned. One that need not
  /// survives kill -9 all the same, and is on the disk with the next one that must.
  enum class Flush { no, yes };

  /// Runs the change; returns when it is on the disk. Throws errors::Error: what the change threw,
  /// or why it could not be committed; then nothing of it is left. A change is run only once,
  /// perhaps by another thread, as if in a transaction of its own.
  void run(const Change& change, Flush flush = Flush::yes);

 private:
  struct Entry {
    const Change* change;
    Flush flush;
    std::optional<errors::Error> error{};
    bool done = false;
  };
  using Entries = std::vector<Entry*>;

  Entries take();
  void commit(const Entries& entries);
  bool apply(const Entries& entries);
  void set_flush(const Entries& entries);

  Connection _connection;
  Settled _settled;
  Flush _flush = Flush::yes;  ///< the mode of the connection's transactions
  bool _in_doubt = false;     ///< a COMMIT failed while flushing, and nothing was committed since
  std::mutex _mutex;
  std::condition_variable _changed;
  std::deque<Entry*> _waiting;
  bool _at_work = false;
};

}  // namespace anticrack::store
