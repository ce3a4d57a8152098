// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/core.h>

#include <string>

#include "errors/errors.hpp"
#include "jobs/job_start.hpp"
#include "jobs/upkeep.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using errors::Reason;

std::string seconds(std::chrono::milliseconds time) {
  const auto milliseconds = time.count();
  return milliseconds % 1000 == 0 ? fmt::format("{} s", milliseconds / 1000)
                                  : fmt::format("{} ms", milliseconds);
}

Error waited_too_long(std::chrono::milliseconds limit) {
  return Error(Reason::timed_out,
               "the job waited {} without being started, as long as it may: submit it again later, "
               "or with a longer queue time-out",
               seconds(limit))
      .at("queue_timeout");
}

Error ran_too_long(std::chrono::milliseconds limit) {
  return Error(Reason::timed_out,
               "the job ran {}, as long as it may: split it, loosen its stopping rule, or submit "
               "it with a longer run time-out",
               seconds(limit))
      .at("run_timeout");
}

}  // namespace

void keep_time_limits(EngineCore& core) {
  EngineCore::Lock lock(core.mutex);
  while (!core.quitting) {
    std::vector<std::pair<JobPtr, Error>> late;
    const auto due = core.deadlines.take(EngineCore::Clock::now());
    for (const auto& [number, what] : due) {
      const JobPtr job = core.numbers.at(number);
      if (what != Due::start)
        late.emplace_back(job, what == Due::queue_time
                                   ? waited_too_long(queue_limit(*job, core.options))
                                   : ran_too_long(run_limit(*job, core.options)));
      else if (job->why == Stop::none)
        core.offer(job);
    }
    if (!late.empty()) {
      lock.unlock();
      for (const auto& [job, error] : late) core.stop(job, Stop::failed, error);
      lock.lock();
    } else if (due.empty()) {
      if (const auto next = core.deadlines.next())
        core.limits.wait_until(lock, *next);
      else
        core.limits.wait(lock);
    }
  }
}

}  // namespace anticrack::jobs
