// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/job_section.hpp"

#include <array>

#include "casefile/duration.hpp"

namespace anticrack::casefile {
namespace {

/// Seconds as a number, or a text with a unit.
std::optional<google::protobuf::Duration> time_of(const Section& section, const std::string& key) {
  const toml::node* node = section.find(key);
  if (!node) return std::nullopt;
  std::optional<std::chrono::milliseconds> time;
  if (const auto text = node->value_exact<std::string>()) {
    time = parse_duration(*text);
  } else if (node->is_number()) {
    time = parse_duration(shown(*node));
  }
  if (!time) {
    throw Error(section.spot_of(key), shown(*node) +
                                          " is not a time above 0; write seconds, or \"90s\", "
                                          "\"10min\", \"2h\", \"1d\"");
  }
  google::protobuf::Duration duration;
  duration.set_seconds(time->count() / 1000);
  duration.set_nanos(static_cast<std::int32_t>(time->count() % 1000 * 1'000'000));
  return duration;
}

}  // namespace

void read_job(const Section& root, v1::Job& job, Spots& spots) {
  const auto section = root.section("job", {"priority", "queue_timeout", "run_timeout"});
  if (!section) return;
  if (const auto priority = section->choice("priority", {"interactive", "normal", "bulk"})) {
    constexpr std::array<v1::Job::Priority, 3> priorities{
        v1::Job::PRIORITY_INTERACTIVE, v1::Job::PRIORITY_NORMAL, v1::Job::PRIORITY_BULK};
    job.set_priority(priorities.at(*priority));
    spots["priority"] = section->spot_of("priority");
  }
  if (const auto time = time_of(*section, "queue_timeout")) {
    *job.mutable_queue_timeout() = *time;
    spots["queue_timeout"] = section->spot_of("queue_timeout");
  }
  if (const auto time = time_of(*section, "run_timeout")) {
    *job.mutable_run_timeout() = *time;
    spots["run_timeout"] = section->spot_of("run_timeout");
  }
}

}  // namespace anticrack::casefile
