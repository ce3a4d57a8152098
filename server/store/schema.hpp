// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tables of the database, and the way from those an older version made to these.
#pragma once

#include <span>

#include "store/sqlite.hpp"

namespace anticrack::store {

/// One after the other, from an empty database to this version's. A step that was in a release is
/// never changed: another is added. PRAGMA user_version is how many have been done.
std::span<const char* const> schema_steps();

/// Does the steps that are still to be done, in one transaction, with a copy of what was there
/// beside it until that is committed ("FILE.before-V", V the version it comes to). Throws
/// errors::Error: storage where a newer anticrack made the database; nothing has changed then.
void migrate(Connection& connection, std::span<const char* const> steps);

/// Reads all of the database. Throws errors::Error (storage) where it is damaged.
void require_sound(Connection& connection);

}  // namespace anticrack::store
