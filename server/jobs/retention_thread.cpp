// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/retention_thread.hpp"

#include <string>
#include <vector>

#include "errors/errors.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using errors::Reason;

constexpr std::chrono::minutes sweep_every{1};

}  // namespace

RetentionThread::RetentionThread(EngineCore& core)
    : _core(core), _thread(core.start(EngineCore::Lock(core.mutex), [this] { work(); })) {}

RetentionThread::~RetentionThread() { _thread.join(); }

void RetentionThread::work() {
  Lock lock(_core.mutex);
  while (!_core.quitting) {
    if (!_core.ended_since_sweep && Clock::now() < _next_sweep) {
      _core.sweeping.wait_until(lock, _next_sweep);
      continue;
    }
    lock.unlock();
    sweep();
    lock.lock();
  }
}

void RetentionThread::sweep() {
  Lock lock(_core.mutex);
  _core.ended_since_sweep = false;
  const auto now = store::Clock::now();
  const Expiry expiry = _core.retention.due(now);
  const bool uploads = Clock::now() >= _next_sweep;
  if (uploads) _next_sweep = Clock::now() + sweep_every;
  lock.unlock();
  std::vector<std::string> expired, erased;
  const auto gone = [](const auto& remove) {
    try {
      remove();
      return true;
    } catch (const Error& error) {
      return error.reason() == Reason::not_found;  // erased by a client in this moment
    }
  };
  for (const std::string& id : expiry.expire)
    if (gone([&] { _core.store.expire(id, now); })) expired.push_back(id);
  for (const std::string& id : expiry.erase)
    if (gone([&] { _core.store.erase_job(id); })) erased.push_back(id);
  if (uploads && _core.options.upload_ttl.count() > 0)
    gone([&] { _core.store.expire_uploads(store::Clock::now() - _core.options.upload_ttl); });
  lock.lock();
  for (const std::string& id : expired) _core.retention.expired(id);
  _core.results_expired += expired.size();
  for (const std::string& id : erased) {
    _core.retention.remove(id);
    _core.logs.remove(id);
  }
}

}  // namespace anticrack::jobs
