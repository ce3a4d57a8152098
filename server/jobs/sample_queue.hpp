// SPDX-License-Identifier: GPL-3.0-or-later
//
// Samples in the order they came, packed in pages: 64 bytes each, one allocation in 256.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>

#include "jobs/event_log.hpp"

namespace anticrack::jobs {

/// Grows at the back, shrinks at the front. Not thread-safe.
class SampleQueue {
 public:
  static constexpr std::size_t bytes_per_sample = 64;

  std::size_t size() const noexcept { return _size; }

  void push_back(const SampleEvent& event) {
    const std::size_t position = _begin + _size;
    if (position == _pages.size() * page_size) {
      _pages.push_back(std::make_unique<Page>());
    }
    const contact::Sample& sample = event.sample;
    (*_pages[position / page_size])[position % page_size] = {
        event.load_case,  sample.iteration, sample.contact_count,
        sample.criterion, sample.energy,    sample.kkt.equilibrium,
        sample.kkt.gap,   sample.kkt.sign,  sample.kkt.complementarity};
    ++_size;
  }

  void pop_front() noexcept {
    --_size;
    if (++_begin == page_size) {
      _pages.pop_front();
      _begin = 0;
    }
  }

  SampleEvent operator[](std::size_t index) const noexcept {
    const std::size_t position = _begin + index;
    const Packed& packed = (*_pages[position / page_size])[position % page_size];
    SampleEvent event;
    event.load_case = packed.load_case;
    event.sample.iteration = packed.iteration;
    event.sample.contact_count = packed.contact_count;
    event.sample.criterion = packed.criterion;
    event.sample.energy = packed.energy;
    event.sample.kkt = {packed.equilibrium, packed.gap, packed.sign, packed.complementarity};
    return event;
  }

 private:
  struct Packed {
    std::int32_t load_case, iteration, contact_count;
    double criterion, energy, equilibrium, gap, sign, complementarity;
  };
  static_assert(sizeof(Packed) == bytes_per_sample);

  static constexpr std::size_t page_size = 256;
  using Page = std::array<Packed, page_size>;

  std::deque<std::unique_ptr<Page>> _pages;
  std::size_t _begin = 0;  ///< of the first sample, in the first page
  std::size_t _size = 0;
};

}  // namespace anticrack::jobs
