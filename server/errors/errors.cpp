// SPDX-License-Identifier: GPL-3.0-or-later
#include "errors/errors.hpp"

#include <fmt/core.h>

#include <array>
#include <utility>

namespace anticrack::errors {

std::string_view name(Reason reason) noexcept {
  constexpr std::array<std::string_view, 26> names{"INVALID_ARGUMENT",
                                                   "CASE_INVALID",
                                                   "GEOMETRY_INVALID",
                                                   "MESH_INVALID",
                                                   "EXPRESSION_INVALID",
                                                   "REQUEST_ID_REUSED",
                                                   "LIMIT_EXCEEDED",
                                                   "NOT_FOUND",
                                                   "NOT_READY",
                                                   "IN_USE",
                                                   "SEQUENCE_TRIMMED",
                                                   "OFFSET_OUT_OF_RANGE",
                                                   "BUSY",
                                                   "QUOTA_EXCEEDED",
                                                   "DRAINING",
                                                   "DISK_FULL",
                                                   "RESULT_EXPIRED",
                                                   "TIMED_OUT",
                                                   "UNAUTHENTICATED",
                                                   "PERMISSION_DENIED",
                                                   "NOT_IMPLEMENTED",
                                                   "CANCELLED",
                                                   "MESHER_FAILED",
                                                   "NUMERICAL",
                                                   "STORAGE",
                                                   "INTERNAL"};
  static_assert(names.size() == static_cast<std::size_t>(Reason::internal) + 1);
  return names[static_cast<std::size_t>(reason)];
}

std::string shown(double value) { return fmt::format("{:.8g}", value); }

std::string shown(double x, double y) { return fmt::format("({:.8g}, {:.8g})", x, y); }

Error& Error::at(std::string field) {
  _fields.push_back({std::move(field), what()});
  return *this;
}

Error& Error::with(std::string key, std::string value) {
  _metadata[std::move(key)] = std::move(value);
  return *this;
}

Error& Error::retry_after(std::chrono::milliseconds delay) {
  _retry_delay = delay;
  return *this;
}

Error& Error::below(std::string_view prefix) {
  return rename([prefix](const std::string& field) {
    return std::string(prefix) + (field.empty() ? "" : ".") + field;
  });
}

}  // namespace anticrack::errors
