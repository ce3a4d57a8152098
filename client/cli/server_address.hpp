// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace anticrack::cli {

/// Throws UsageError, with the cure, for what is neither HOST:PORT nor an address with a scheme of
/// gRPC as unix:PATH: gRPC would take another port and say nothing.
void check_server_address(const std::string& address);

}  // namespace anticrack::cli
