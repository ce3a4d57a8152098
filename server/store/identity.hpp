// SPDX-License-Identifier: GPL-3.0-or-later
//
// Checks that the database and the files beside it belong to one store. Both have its identity, a
// random number: in a row of the database, and in a file of the folder. Files to which no record
// refers may be removed only if the two agree.
#pragma once

#include <string>

#include "store/sqlite.hpp"

namespace anticrack::store {

/// Throws errors::Error (storage) if a store has left something in the folder, but its database is
/// missing or empty. To be called before SQLite makes a database.
void require_database(const std::string& folder);

/// Throws errors::Error (storage) if the database is empty, of another version or of another store,
/// before anything is changed. If the folder has no identity, the database counts as its own if it
/// names a file there, or if there are no files.
void require_own(Connection& connection, const std::string& folder);

/// Writes the database's identity into the folder if it is not there yet. Throws as disk_error
/// does.
void keep_identity(Connection& connection, const std::string& folder);

}  // namespace anticrack::store
