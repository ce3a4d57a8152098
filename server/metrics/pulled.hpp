// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <prometheus/metric_family.h>

#include <vector>

#include "metrics/metrics.hpp"

namespace anticrack::metrics {

/// The families that are read, not counted. Pure.
std::vector<prometheus::MetricFamily> server_families(const Snapshot& snapshot);

/// What every process has, under the names Prometheus' own clients use. `started`: seconds since
/// 1970.
std::vector<prometheus::MetricFamily> process_families(double started);

}  // namespace anticrack::metrics
