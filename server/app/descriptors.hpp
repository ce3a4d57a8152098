// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "app/config.hpp"

namespace anticrack::app {

/// Raises the limit of open files to the hard one, at most to a million, and returns it. The helper
/// sets its own limit.
std::uint64_t raise_descriptor_limit() noexcept;

/// Descriptors that are not connections: of the database, helpers, results, uploads and downloads.
int other_descriptors(const Config& config);

/// Sets the number of connections where none is given, to the default or what `descriptors` leave.
/// Throws ConfigError where they do not suffice for what is given, or for a server at all.
void fit_connections(Config& config, std::uint64_t descriptors);

}  // namespace anticrack::app
