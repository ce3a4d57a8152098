// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/config.hpp"
#include "rpc/server.hpp"

namespace anticrack::app {

struct LoadedSecurity {
  rpc::Security security;
  /// Risky settings, for the log.
  std::vector<std::string> warnings;
};

/// Reads certificates, key and tokens. Throws ConfigError.
LoadedSecurity load_security(const Config& config);

/// Opens all that the configuration names: certificates, keys, tokens, the data folder, the helper.
/// Returns a sentence for each that cannot be used. Changes nothing.
std::vector<std::string> problems_of_files(const Config& config);

/// "ann, bob" -> {"ann", "bob"}; empty names are left out.
std::vector<std::string> split_names(const std::string& names);

}  // namespace anticrack::app
