// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
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

/// Adds the message of the ConfigError that `check` throws, if it does.
void note_problem(std::vector<std::string>& problems, const std::function<void()>& check);

/// The faults for which load_security() would throw, a sentence for each file.
std::vector<std::string> problems_of_security(const Config& config);

/// "ann, bob" -> {"ann", "bob"}; empty names are left out.
std::vector<std::string> split_names(const std::string& names);

}  // namespace anticrack::app
