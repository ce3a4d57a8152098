// SPDX-License-Identifier: GPL-3.0-or-later
//
// The tables of the database.
#pragma once

#include "store/sqlite.hpp"

namespace anticrack::store {

/// Makes the tables in an empty database, in one transaction. Throws as require_version does, and
/// then changes nothing.
void make_tables(Connection& connection);

/// Throws errors::Error (storage) if an anticrack with other tables or records made the database.
void require_version(Connection& connection);

/// Reads all of the database. Throws errors::Error (storage) if it is damaged.
void require_sound(Connection& connection);

}  // namespace anticrack::store
