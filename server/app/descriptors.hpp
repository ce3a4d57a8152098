// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "app/config.hpp"

namespace anticrack::app {

/// Raises the limit of open files to the hard limit, at most to a million, and returns it. The
/// helper sets its own limit.
std::uint64_t raise_descriptor_limit() noexcept;

/// How many descriptors others than connections need: database, helpers, results, uploads,
/// downloads.
int other_descriptors(const Config& config);

/// Sets the number of connections if none is given, to the default or to what `descriptors` leave.
/// Throws ConfigError if they do not suffice for the given number, or for a server at all.
void fit_connections(Config& config, std::uint64_t descriptors);

}  // namespace anticrack::app
