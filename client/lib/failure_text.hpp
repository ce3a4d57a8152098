// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a failed call is called in front of people. Pure.
#pragma once

#include <string>
#include <string_view>

#include "client/credentials.hpp"
#include "client/error.hpp"

namespace anticrack::client {

/// Why the server cannot be reached and what to check. `story`: gRPC's own message, cause last.
std::string unreachable_text(const std::string& address, const Credentials& credentials,
                             std::string_view story);

/// UNAUTHENTICATED and PERMISSION_DENIED: what the server said, and the option that cures it.
std::string refused_text(Code code, const std::string& message, const Credentials& credentials);

}  // namespace anticrack::client
