// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/status.hpp"

#include <array>
#include <utility>

namespace anticrack::results {
namespace {

constexpr std::array<std::pair<Status, std::string_view>, 7> statuses{{
    {Status::unspecified, "unspecified"},
    {Status::pending, "pending"},
    {Status::running, "running"},
    {Status::converged, "converged"},
    {Status::not_converged, "not_converged"},
    {Status::failed, "failed"},
    {Status::cancelled, "cancelled"},
}};

}  // namespace

std::string_view name(Status status) noexcept {
  for (const auto& [value, text] : statuses)
    if (value == status) return text;
  return {};
}

std::optional<Status> status_from(std::string_view name) noexcept {
  for (const auto& [value, text] : statuses)
    if (text == name) return value;
  return std::nullopt;
}

}  // namespace anticrack::results
