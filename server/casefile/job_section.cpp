// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/sections.hpp"
#include "words/duration.hpp"

namespace anticrack::casefile {

std::optional<google::protobuf::Duration> read_time(const Section& section, const char* key) {
  const toml::node* node = section.find(key);
  if (!node) return std::nullopt;
  const std::string text = node->value_exact<std::string>().value_or(shown(*node));
  const auto time =
      node->is_string() || node->is_number() ? words::parse_duration(text) : std::nullopt;
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

void read_job(const Section& root, v1::Job& job, Spots& spots) {
  const auto section = root.section("job", {"priority", "queue_timeout", "run_timeout"});
  if (!section) return;
  note(*section, "", spots);
  if (const auto priority = section->choice("priority", {"interactive", "normal", "bulk"})) {
    job.set_priority(static_cast<v1::Job::Priority>(v1::Job::PRIORITY_INTERACTIVE +
                                                    static_cast<int>(*priority)));
  }
  if (const auto time = read_time(*section, "queue_timeout")) *job.mutable_queue_timeout() = *time;
  if (const auto time = read_time(*section, "run_timeout")) *job.mutable_run_timeout() = *time;
}

void read_units(const Section& root, v1::Job& job, Spots& spots) {
  const auto section = root.section("units", {"length", "force"});
  if (!section) return;
  note(*section, "units", spots);
  job.mutable_units()->set_length(section->text("length").value_or(""));
  job.mutable_units()->set_force(section->text("force").value_or(""));
}

}  // namespace anticrack::casefile
