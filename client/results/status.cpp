// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/status.hpp"

#include <algorithm>
#include <array>

namespace anticrack::results {
namespace {

/// By the number of the Status.
constexpr std::array<std::string_view, 7> names{"unspecified",   "pending", "running",  "converged",
                                                "not_converged", "failed",  "cancelled"};

}  // namespace

std::string_view name(Status status) noexcept {
  const auto index = static_cast<std::size_t>(status);
  return index < names.size() ? names[index] : std::string_view();
}

std::optional<Status> status_from(std::string_view name) noexcept {
  const auto* found = std::ranges::find(names, name);
  if (found == names.end()) return std::nullopt;
  return static_cast<Status>(found - names.begin());
}

}  // namespace anticrack::results
