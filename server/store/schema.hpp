// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tables of the database.
#pragma once

#include "store/sqlite.hpp"

namespace anticrack::store {

/// Makes the tables in an empty database, in one transaction. Throws as require_version does;
/// nothing has changed then.
void make_tables(Connection& connection);

/// Throws errors::Error (storage) where an anticrack with other tables or records made the
/// database.
void require_version(Connection& connection);

/// Reads all of the database. Throws errors::Error (storage) where it is damaged.
void require_sound(Connection& connection);

}  // namespace anticrack::store
