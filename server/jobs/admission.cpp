// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/admission.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "access/share.hpp"
#include "errors/errors.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using errors::Reason;

constexpr std::chrono::milliseconds shortest_delay{1'000};
constexpr std::chrono::milliseconds delay_per_job{50};
constexpr std::chrono::milliseconds longest_delay{60'000};

void require_possible(std::uint64_t value, std::uint64_t limit, const char* what) {
  if (value > limit) {
    throw Error(Reason::limit_exceeded,
                "the job has {} {} and the queue takes {} at most: split the job", value, what,
                limit)
        .at("load_cases");
  }
}

}  // namespace

std::chrono::milliseconds Admission::retry_delay(std::uint64_t jobs) noexcept {
  const auto counted = static_cast<std::int64_t>(std::min<std::uint64_t>(jobs, 1'000'000));
  return std::min(longest_delay, shortest_delay + delay_per_job * counted);
}

void Admission::check(const std::string& owner, const std::string& mesh, std::uint64_t cases,
                      std::uint64_t bytes, std::uint64_t memory) const {
  const auto held = _owners.find(owner);
  const Held own = held == _owners.end() ? Held() : held->second;
  const auto waiting = _cases.find(mesh);
  check(owner, mesh, cases, bytes,
        {_jobs, memory, own.jobs, own.bytes, waiting == _cases.end() ? 0 : waiting->second});
}

void Admission::check(const std::string& owner, const std::string& mesh, std::uint64_t cases,
                      std::uint64_t bytes, const store::QueueTotals& held) const {
  require_possible(cases, _limits.cases, "load cases");
  require_possible(bytes, _limits.memory, "bytes of load cases");
  const auto full = [&](const std::string& what) {
    Error error(Reason::busy, "the queue is full (" + what + "): try again in a while");
    return error.retry_after(retry_delay(held.jobs));
  };
  if (held.jobs >= _limits.jobs) {
    throw full(fmt::format("{} jobs have not ended, at most {}", held.jobs, _limits.jobs));
  }
  if (!owner.empty() && held.own_jobs > 0) {
    if (!access::may_have(held.own_jobs, 1, held.jobs, _limits.jobs)) {
      throw full(fmt::format("you have {} jobs that have not ended, one user may have {} now",
                             held.own_jobs, access::share(held.own_jobs, held.jobs, _limits.jobs)));
    }
    if (!access::may_have(held.own_bytes, bytes, held.bytes, _limits.memory)) {
      throw full(fmt::format(
          "your jobs that have not ended take {} bytes and this one {}, those of one "
          "user may take {} now",
          held.own_bytes, bytes, access::share(held.own_bytes, held.bytes, _limits.memory)));
    }
  }
  if (held.mesh_cases + cases > _limits.cases) {
    throw full(fmt::format("{} load cases of meshes/{} have not ended, at most {}", held.mesh_cases,
                           mesh, _limits.cases));
  }
  if (held.bytes + bytes > _limits.memory) {
    throw full(fmt::format("jobs use {} bytes of memory, at most {}", held.bytes, _limits.memory));
  }
}

void Admission::add(const std::string& owner, const std::string& mesh, std::uint64_t cases,
                    std::uint64_t bytes) {
  Held& held = _owners[owner];
  ++held.jobs;
  held.bytes += bytes;
  _cases[mesh] += cases;
  _bytes += bytes;
  ++_jobs;
  ++_waiting;
}

void Admission::ended(const std::string& owner, std::uint64_t bytes) {
  const auto found = _owners.find(owner);
  found->second.bytes -= bytes;
  if (--found->second.jobs == 0) _owners.erase(found);
  _bytes -= bytes;
  --_jobs;
}

void Admission::cases_ended(const std::string& mesh, std::uint64_t count) {
  const auto found = _cases.find(mesh);
  if (found != _cases.end() && (found->second -= count) == 0) _cases.erase(found);
}

}  // namespace anticrack::jobs
