// SPDX-License-Identifier: GPL-3.0-or-later
//
// Events that say themselves which they are.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "jobs/event_log.hpp"
#include "records/job_record.hpp"

namespace anticrack::jobs {

inline constexpr std::size_t roomy = 16U << 20U;

inline SampleEvent sample(std::int32_t load_case, int iteration) {
  SampleEvent event{load_case, {}};
  event.sample.iteration = iteration;
  event.sample.criterion = 1.0 / iteration;
  event.sample.energy = -iteration;
  event.sample.contact_count = iteration % 7;
  event.sample.kkt = {iteration + 0.1, iteration + 0.2, iteration + 0.3, iteration + 0.4};
  return event;
}

inline std::vector<SampleEvent> samples(int first, int count) {
  std::vector<SampleEvent> result;
  for (int i = first; i < first + count; ++i) {
    result.push_back(sample(0, i));
  }
  return result;
}

inline EndEvent end_event() {
  auto record = std::make_shared<records::JobRecord>();
  record->id = "job";
  return {std::move(record)};
}

/// Every 5th event is a phase, the others samples; the number of each is in it.
inline Event mixed(int number) {
  return number % 5 == 0 ? Event(PhaseEvent{records::JobState::running, std::to_string(number)})
                         : Event(sample(0, number));
}

inline int number_of(const Event& event) {
  const auto* phase = std::get_if<PhaseEvent>(&event);
  return phase != nullptr ? std::stoi(phase->detail)
                          : std::get<SampleEvent>(event).sample.iteration;
}

}  // namespace anticrack::jobs
