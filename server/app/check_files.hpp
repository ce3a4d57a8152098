// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/config.hpp"

namespace anticrack::app {

/// Opens all that the configuration names: certificates, keys, tokens, the data folder, the helper.
/// Returns a sentence for each that cannot be used. Changes nothing.
std::vector<std::string> problems_of_files(const Config& config);

}  // namespace anticrack::app
