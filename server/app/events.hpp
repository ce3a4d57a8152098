// SPDX-License-Identifier: GPL-3.0-or-later
//
// What happened, told to the log and to the metrics. For the callbacks of the layers below:
// thread-safe, quick, throwing nothing.
#pragma once

#include <chrono>

#include "metrics/metrics.hpp"
#include "store/records.hpp"

namespace anticrack::app {

/// Each counts what happened and logs a line of it, or fails in silence: a line that cannot be
/// written is no reason to lose a result.
void job_ended(metrics::Metrics& metrics, const store::JobRecord& job) noexcept;
void meshed(metrics::Metrics& metrics, const store::MeshRecord& mesh) noexcept;
void factorised(metrics::Metrics& metrics, std::chrono::duration<double> time) noexcept;

}  // namespace anticrack::app
