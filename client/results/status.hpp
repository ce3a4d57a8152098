// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace anticrack::results {

/// How a load case ended. The numbers are those of the API's LoadCaseAnswer.Status.
enum class Status : std::int32_t {
  unspecified = 0,
  pending = 1,
  running = 2,
  converged = 3,
  not_converged = 4,  ///< keeps its last traces; `reason` says why
  failed = 5,         ///< no traces; `error` says why
  cancelled = 6,
};

/// The attribute `status` of the file, by the number of the Status.
inline constexpr std::array<std::string_view, 7> status_names{
    "unspecified", "pending", "running", "converged", "not_converged", "failed", "cancelled"};

/// "converged", "not_converged", ... Empty if unknown.
constexpr std::string_view name(Status status) noexcept {
  const auto index = static_cast<std::size_t>(status);
  return index < status_names.size() ? status_names[index] : std::string_view();
}

}  // namespace anticrack::results
