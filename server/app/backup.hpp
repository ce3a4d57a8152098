// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <iosfwd>
#include <string>

#include "app/config.hpp"

namespace anticrack::app {

/// Implements --backup: copies the data folder to the new folder `to`, while a server may serve it,
/// and prints what was copied. Returns the exit code, 0. Throws as store::back_up() does.
int back_up(const Config& config, const std::string& to, std::ostream& out);

}  // namespace anticrack::app
