// SPDX-License-Identifier: GPL-3.0-or-later
#include "postgres/pool.hpp"

#include <algorithm>
#include <random>
#include <thread>

#include "stop/stop.hpp"

namespace anticrack::postgres {

namespace {

using std::chrono::milliseconds;

constexpr milliseconds first_delay{10}, longest_delay{2'000};

/// first_delay * 2^n at most longest, less up to a half, so that many do not come back at once.
milliseconds delay_after(unsigned attempts, milliseconds longest) {
  thread_local std::minstd_rand random{std::random_device{}()};
  const milliseconds whole = std::min(longest, first_delay * (1U << std::min(attempts, 10U)));
  return whole - milliseconds(random() % static_cast<unsigned>(whole.count() / 2 + 1));
}

void sleep(milliseconds time) {
  const auto until = std::chrono::steady_clock::now() + time;
  while (std::chrono::steady_clock::now() < until) {
    stop::look("waiting for the database");
    std::this_thread::sleep_until(
        std::min(until, std::chrono::steady_clock::now() + milliseconds(50)));
  }
}

/// Calls attempt(repeated) until it succeeds, fails for good or has been tried for long enough.
template <class Attempt>
void persist(Pool& pool, const Attempt& attempt) {
  const auto until = std::chrono::steady_clock::now() + pool.settings().patience;
  bool repeated = false;
  for (unsigned attempts = 0;; ++attempts) {
    try {
      const auto began = std::chrono::steady_clock::now();
      attempt(repeated);
      if (pool.settings().answered)
        pool.settings().answered(std::chrono::steady_clock::now() - began);
      return;
    } catch (const Failure& failure) {
      const bool again = failure.policy() == Policy::retry || failure.policy() == Policy::reconnect;
      if (!again || std::chrono::steady_clock::now() >= until) throw;
    }
    sleep(delay_after(attempts, milliseconds(300)));
  }
}

}  // namespace

std::unique_ptr<Connection> Pool::connect() {
  std::unique_lock lock(_mutex);
  const auto wait = std::chrono::duration_cast<milliseconds>(_next_try - Clock::now());
  const std::size_t server = _server % _settings.address.servers().size();
  lock.unlock();
  if (wait.count() > 0) sleep(wait);
  try {
    auto made = std::make_unique<Connection>(_settings, _settings.address.servers()[server]);
    lock.lock();
    _failures = 0;
    _lost_since.reset();
    return made;
  } catch (const Failure&) {
    lock.lock();
    if (!_lost_since) _lost_since = Clock::now();
    _server = server + 1;
    // Once around the servers before any delay.
    if (_server % _settings.address.servers().size() == 0)
      _next_try = Clock::now() + delay_after(_failures++, longest_delay);
    throw;
  }
}

Pool::Lease Pool::take() {
  std::unique_lock lock(_mutex);
  const auto deadline = Clock::now() + _settings.call_time;
  while (_idle.empty() && _open >= _settings.connections) {
    if (_given_back.wait_for(lock, milliseconds(100)) == std::cv_status::timeout) {
      lock.unlock();
      stop::look("waiting for the database");
      lock.lock();
    }
    if (_idle.empty() && _open >= _settings.connections && Clock::now() > deadline) {
      throw Failure("53300", _settings.address.shown(),
                    fmt::format("all {} connections are busy", _settings.connections));
    }
  }
  if (!_idle.empty()) {
    std::unique_ptr<Connection> connection = std::move(_idle.back());
    _idle.pop_back();
    return {*this, std::move(connection)};
  }
  ++_open;
  lock.unlock();
  try {
    return {*this, connect()};
  } catch (...) {
    give_back(nullptr);
    throw;
  }
}

void Pool::give_back(std::unique_ptr<Connection> connection) noexcept {
  std::vector<std::unique_ptr<Connection>> closed;
  {
    const std::lock_guard lock(_mutex);
    if (connection && !connection->broken()) {
      _idle.push_back(std::move(connection));
    } else {
      --_open;
      if (connection) {  // the others are of no more use, most likely
        _open -= _idle.size();
        closed.swap(_idle);
      }
    }
  }
  _given_back.notify_all();
}

milliseconds Pool::unreachable() const {
  const std::lock_guard lock(_mutex);
  return _lost_since ? std::chrono::duration_cast<milliseconds>(Clock::now() - *_lost_since) +
                           milliseconds(1)
                     : milliseconds(0);
}

void transact(Pool& pool, const std::function<void(Transaction&)>& work) {
  persist(pool, [&](bool& repeated) {
    const Pool::Lease connection = pool.take();
    connection->execute("BEGIN");
    try {
      Transaction transaction(*connection, repeated);
      work(transaction);
    } catch (...) {
      if (!connection->broken()) {
        try {
          connection->execute("ROLLBACK");
        } catch (const errors::Error&) {  // the connection is broken now, and the server rolls back
        }
      }
      throw;
    }
    try {
      connection->commit();
    } catch (const Failure& failure) {
      repeated = repeated || failure.policy() == Policy::reconnect;
      throw;
    }
  });
}

Result query(Pool& pool, const std::string& sql, Values values) {
  std::optional<Result> result;
  persist(pool, [&](bool&) {
    const Pool::Lease connection = pool.take();
    result.emplace(connection->run(sql, values));
  });
  return std::move(*result);
}

}  // namespace anticrack::postgres
