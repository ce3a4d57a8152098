// SPDX-License-Identifier: GPL-3.0-or-later
//
// Events for the log and the metrics, called from the layers below: thread-safe and quick.
#pragma once

#include <chrono>

#include "metrics/metrics.hpp"

namespace anticrack::records {
struct JobRecord;
struct MeshRecord;
}  // namespace anticrack::records

namespace anticrack::app {

/// Count the event and log one line. Errors are ignored: a log line that cannot be written must not
/// cost a result.
void job_ended(metrics::Metrics& metrics, const records::JobRecord& job) noexcept;
void meshed(metrics::Metrics& metrics, const records::MeshRecord& mesh) noexcept;
void factorised(metrics::Metrics& metrics, std::chrono::duration<double> time) noexcept;

}  // namespace anticrack::app
