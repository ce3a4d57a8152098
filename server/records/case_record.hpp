// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <optional>

#include "contact/answer.hpp"
#include "contact/status.hpp"
#include "errors/errors.hpp"
#include "fields/fields.hpp"

namespace anticrack::records {

/// A load case's answer without its arrays, which are in the result block.
struct CaseRecord {
  contact::Status status = contact::Status::pending;
  std::optional<errors::Error> error;  ///< when failed
  contact::AnswerSummary answer;
  std::chrono::nanoseconds solve_time{0};
};
ANTICRACK_FIELDS(CaseRecord, status, error, answer, solve_time)

}  // namespace anticrack::records
