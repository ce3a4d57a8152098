// SPDX-License-Identifier: GPL-3.0-or-later
//
// How urgent it is what waits.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "store/records.hpp"

namespace anticrack::meshes {

/// Waiting this long is worth one class of priority.
constexpr std::chrono::seconds ageing{30};
constexpr std::size_t priority_classes = 3;

/// 0 is the most urgent.
constexpr std::size_t class_of(store::Priority priority) noexcept {
  return static_cast<std::size_t>(priority) -
         static_cast<std::size_t>(store::Priority::interactive);
}

/// The class to which something of `priority_class` has risen that has waited since `since`: 0 at
/// last.
inline int urgency(std::size_t priority_class, std::chrono::steady_clock::time_point since,
                   std::chrono::steady_clock::time_point now) noexcept {
  const std::int64_t risen = static_cast<std::int64_t>(priority_class) - (now - since) / ageing;
  return static_cast<int>(std::max<std::int64_t>(0, risen));
}

}  // namespace anticrack::meshes
