// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/config.hpp"

namespace anticrack::app {

/// Opens what the configuration names: certificates, keys, tokens, the data folder, the helper.
/// One sentence for each that cannot be used. Changes nothing.
std::vector<std::string> problems_of_files(const Config& config);

}  // namespace anticrack::app
