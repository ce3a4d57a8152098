// SPDX-License-Identifier: GPL-3.0-or-later
//
// Samples in the order they came, as columns in pages: 60 bytes each, one allocation per 256.
#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "jobs/sample_run.hpp"

namespace anticrack::jobs {

/// Grows at the back and shrinks at the front. Not thread-safe, but runs that it gave out may be
/// read while it grows and shrinks, because an entry is written once, before it is given out.
class SampleQueue {
 public:
  std::size_t size() const noexcept { return _size; }
  /// Memory of the samples in bytes.
  std::size_t bytes() const noexcept { return _size * SamplePage::bytes_per_sample; }

  /// Appends all of them, or none if there is no memory (std::bad_alloc).
  void push_back(std::span<const SampleEvent> events) {
    while (_begin + _size + events.size() > _pages.size() * SamplePage::capacity)
      _pages.push_back(std::make_shared_for_overwrite<SamplePage>());
    while (!events.empty()) {
      const std::size_t position = _begin + _size;
      const std::size_t place = position % SamplePage::capacity;
      const std::size_t count = std::min(events.size(), SamplePage::capacity - place);
      write(events.first(count), *_pages[position / SamplePage::capacity], place);
      _size += count;
      events = events.subspan(count);
    }
  }

  /// Removes the first `count` samples, at most size().
  void pop_front(std::size_t count) noexcept {
    _size -= count;
    _begin += count;
    for (; _begin >= SamplePage::capacity; _begin -= SamplePage::capacity) _pages.pop_front();
  }

  /// `count` samples from number `index` on; all must exist. O(count / page).
  std::vector<SampleRun> runs(std::size_t index, std::size_t count) const {
    std::vector<SampleRun> result;
    result.reserve(count / SamplePage::capacity + 2);
    for (std::size_t position = _begin + index; count > 0;) {
      const std::size_t place = position % SamplePage::capacity;
      const std::size_t size = std::min(count, SamplePage::capacity - place);
      result.push_back({_pages[position / SamplePage::capacity], place, size});
      position += size;
      count -= size;
    }
    return result;
  }

 private:
  static void write(std::span<const SampleEvent> events, SamplePage& page, std::size_t place) {
    for (const SampleEvent& event : events) {
      const contact::Sample& sample = event.sample;
      page.load_case[place] = event.load_case;
      page.iteration[place] = sample.iteration;
      page.contact_count[place] = sample.contact_count;
      page.criterion[place] = sample.criterion;
      page.energy[place] = sample.energy;
      page.equilibrium[place] = sample.kkt.equilibrium;
      page.gap[place] = sample.kkt.gap;
      page.sign[place] = sample.kkt.sign;
      page.complementarity[place] = sample.kkt.complementarity;
      ++place;
    }
  }

  std::deque<std::shared_ptr<SamplePage>> _pages;
  std::size_t _begin = 0;  ///< index of the first sample in the first page
  std::size_t _size = 0;
};

}  // namespace anticrack::jobs
