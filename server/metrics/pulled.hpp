// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <prometheus/metric_family.h>

#include <vector>

#include "metrics/metrics.hpp"

namespace anticrack::metrics {

/// How many owners have their own labels; the others together are "(others)".
constexpr std::size_t most_owners = 50;

/// The families that are read at a scrape. Pure.
std::vector<prometheus::MetricFamily> server_families(const Snapshot& snapshot);

/// Those of several servers on one store. `leases_lost`: by this one.
std::vector<prometheus::MetricFamily> group_families(const store::GroupState& group,
                                                     std::uint64_t leases_lost);

/// The process_* families of Prometheus' own clients. `started`: seconds since 1970.
std::vector<prometheus::MetricFamily> process_families(double started);

}  // namespace anticrack::metrics
