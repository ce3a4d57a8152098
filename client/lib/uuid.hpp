// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace anticrack::client {

/// A random UUID (version 4), 36 characters, which makes a submission idempotent.
std::string make_uuid();

}  // namespace anticrack::client
