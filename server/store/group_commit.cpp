// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/group_commit.hpp"

#include <algorithm>
#include <exception>

namespace anticrack::store {

namespace {

using errors::Error;
using errors::Reason;

/// Most changes in one transaction, so that the first of a long queue does not wait for the last.
constexpr std::size_t max_together = 64;

/// The error that a call threw, as a value: threads would share an exception that several hold.
template <class Call>
std::optional<Error> error_of(Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    return error;
  } catch (const std::exception& error) {
    return Error(Reason::internal, error.what());
  }
  return std::nullopt;
}

}  // namespace

void GroupCommit::run(const Change& change, Flush flush) {
  Entry entry{&change, flush};
  std::unique_lock lock(_mutex);
  _waiting.push_back(&entry);
  _changed.wait(lock, [&] { return entry.done || !_at_work; });
  if (!entry.done) {
    _at_work = true;
    while (!entry.done) {
      const Entries entries = take();
      lock.unlock();
      commit(entries);
      lock.lock();
      for (Entry* each : entries) each->done = true;
      _at_work = !entry.done;
      _changed.notify_all();
    }
  }
  if (entry.error) throw Error(*entry.error);
}

GroupCommit::Entries GroupCommit::take() {
  const auto end =
      _waiting.begin() + static_cast<std::ptrdiff_t>(std::min(_waiting.size(), max_together));
  Entries entries(_waiting.begin(), end);
  _waiting.erase(_waiting.begin(), end);
  return entries;
}

void GroupCommit::commit(const Entries& entries) {
  bool committing = false;
  const std::optional<Error> failure = error_of([&] {
    set_flush(entries);
    Transaction transaction(_connection);
    const bool changed = apply(entries);
    committing = true;
    transaction.commit();
    _in_doubt = _in_doubt && !changed;
  });
  for (Entry* entry : entries)
    if (failure && !entry->error) entry->error = failure;
  _in_doubt = _in_doubt || (failure && committing);
  if (!_in_doubt) {
    // The changes are done or refused already; cleaning up is tried again after the next.
    error_of([&] { _settled(_connection); });
  }
}

void GroupCommit::set_flush(const Entries& entries) {
  const bool any =
      std::ranges::any_of(entries, [](const Entry* entry) { return entry->flush == Flush::yes; });
  if (const Flush wanted = any ? Flush::yes : Flush::no; wanted != _flush) {
    _connection.execute(any ? "PRAGMA synchronous = FULL" : "PRAGMA synchronous = NORMAL");
    _flush = wanted;
  }
}

/// Whether there is anything to commit.
bool GroupCommit::apply(const Entries& entries) {
  bool changed = false;
  for (Entry* entry : entries) {
    const std::int64_t before = _connection.total_changes();
    _connection.execute("SAVEPOINT change");
    entry->error = error_of([&] { (*entry->change)(_connection); });
    if (!_connection.in_transaction()) {
      // A failing disk has made SQLite roll back everything: the changes before are gone as well.
      throw Error(entry->error.value_or(Error(Reason::internal, "a change ended its transaction")));
    }
    _connection.execute(entry->error ? "ROLLBACK TO change; RELEASE change" : "RELEASE change");
    changed = changed || (!entry->error && _connection.total_changes() != before);
  }
  return changed;
}

}  // namespace anticrack::store
