// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sweeps as messages. Pure functions.
#pragma once

#include <cstddef>

#include "anticrack/v1/solve.pb.h"
#include "jobs/event_log.hpp"
#include "store/records.hpp"

namespace anticrack::rpc {

/// What was asked for. The matrix is named as the upload it is kept as, however it came: a job is
/// answered often, and a matrix of a megabyte would travel each time.
v1::Sweep from_domain(const store::SweepSpec& sweep);

/// How it ended. Rows are counted before that, so that progress can be told.
v1::SweepAnswer from_domain(const store::SweepSpec& sweep, const store::SweepRecord& record);

/// One for one.
v1::LoadCaseAnswer::Status from_domain(contact::Status status) noexcept;

/// Appends rows of the event, from its row `first` on: `count` of them, or as many as there are.
/// `rows` is empty, or ends with the row before. O(count inclusions), one reservation an array.
void append(v1::SweepRows& rows, const jobs::RowsEvent& event, std::size_t first,
            std::size_t count);

}  // namespace anticrack::rpc
