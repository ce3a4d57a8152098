// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
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

/// "converged", "not_converged", ...: the attribute `status` of the file. Empty if unknown.
std::string_view name(Status status) noexcept;
/// Inverse of `name`; empty for an unknown name.
std::optional<Status> status_from(std::string_view name) noexcept;

}  // namespace anticrack::results
