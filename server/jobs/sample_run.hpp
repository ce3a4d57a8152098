// SPDX-License-Identifier: GPL-3.0-or-later
//
// Samples as columns, as a log keeps them and its readers get them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "contact/observer.hpp"

namespace anticrack::jobs {

struct SampleEvent {
  std::int32_t load_case = 0;
  contact::Sample sample;
};

/// Consecutive samples; entry k of every column belongs to sample k.
struct SamplePage {
  static constexpr std::size_t capacity = 256;
  static constexpr std::size_t bytes_per_sample = 3 * sizeof(std::int32_t) + 6 * sizeof(double);

  template <class T>
  using Column = std::array<T, capacity>;

  Column<std::int32_t> load_case, iteration, contact_count;
  Column<double> criterion, energy, equilibrium, gap, sign, complementarity;
};
static_assert(sizeof(SamplePage) == SamplePage::capacity * SamplePage::bytes_per_sample);

/// Samples of a page, in the log's own memory, so that nothing is copied. They do not change, and
/// stay as long as the run exists, even if the log drops them.
struct SampleRun {
  std::shared_ptr<const SamplePage> page;
  std::size_t first = 0;
  std::size_t count = 0;

  /// The run's part of a column of the page, e.g. of &SamplePage::energy.
  template <class T>
  std::span<const T> column(SamplePage::Column<T> SamplePage::*member) const noexcept {
    return std::span<const T>((*page).*member).subspan(first, count);
  }

  SampleEvent operator[](std::size_t index) const noexcept {
    const SamplePage& from = *page;
    const std::size_t i = first + index;
    SampleEvent event;
    event.load_case = from.load_case[i];
    event.sample.iteration = from.iteration[i];
    event.sample.criterion = from.criterion[i];
    event.sample.energy = from.energy[i];
    event.sample.contact_count = from.contact_count[i];
    event.sample.kkt = {from.equilibrium[i], from.gap[i], from.sign[i], from.complementarity[i]};
    return event;
  }
};

}  // namespace anticrack::jobs
