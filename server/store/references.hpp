// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "store/disk_usage.hpp"
#include "store/sqlite.hpp"

namespace anticrack::store {

/// Whether a record refers to the file. Throws as Connection does.
bool is_referenced(Connection& connection, FileKind kind, const std::string& sha256);

}  // namespace anticrack::store
