// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>
#include <vector>

#include "errors/errors.hpp"
#include "jobs/upkeep.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using errors::Reason;
using Clock = EngineCore::Clock;

constexpr std::chrono::minutes sweep_every{1};

void sweep(EngineCore& core, bool uploads) {
  std::vector<store::EndedJob> all;  // those that other servers ended as well
  if (uploads && core.queue != nullptr) all = core.store.ended();
  EngineCore::Lock lock(core.mutex);
  if (!all.empty()) core.retention.replace(std::move(all));
  core.ended_since_sweep = false;
  const auto now = records::Clock::now();
  const Expiry expiry = core.retention.due(now);
  lock.unlock();
  std::vector<std::string> expired, erased;
  const auto gone = [](const auto& remove) {
    try {
      remove();
      return true;
    } catch (const Error& error) {
      return error.reason() == Reason::not_found;  // a client has just erased it
    }
  };
  for (const std::string& id : expiry.expire)
    if (gone([&] { core.store.expire(id, now); })) expired.push_back(id);
  for (const std::string& id : expiry.erase)
    if (gone([&] { core.store.erase_job(id); })) erased.push_back(id);
  if (uploads && core.options.upload_ttl.count() > 0)
    gone([&] { core.store.expire_uploads(records::Clock::now() - core.options.upload_ttl); });
  lock.lock();
  for (const std::string& id : expired) core.retention.expired(id);
  core.results_expired += expired.size();
  for (const std::string& id : erased) {
    core.retention.remove(id);
    core.logs.remove(id);
  }
}

}  // namespace

void remove_what_is_too_old(EngineCore& core) {
  EngineCore::Lock lock(core.mutex);
  for (Clock::time_point next{}; !core.quitting;) {
    const bool due = Clock::now() >= next;
    if (!due && !core.ended_since_sweep) {
      core.sweeping.wait_until(lock, next);
      continue;
    }
    if (due) next = Clock::now() + sweep_every;
    lock.unlock();
    sweep(core, due);
    lock.lock();
  }
}

}  // namespace anticrack::jobs
