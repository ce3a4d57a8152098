// SPDX-License-Identifier: GPL-3.0-or-later
//
// Whether the database and the files beside it are of one store. Both carry its identity, a random
// number: a row of the database, and a file of the folder. Files that no record refers to may be
// removed only where the two agree.
#pragma once

#include <string>

#include "store/sqlite.hpp"

namespace anticrack::store {

/// Throws errors::Error (storage) where a store has left something in the folder and its database
/// is missing or has no byte. To be called before SQLite makes one.
void require_database(const std::string& folder);

/// Throws errors::Error (storage) where the database is empty, of another version or another
/// store's, before anything is changed in either. Where the folder has no identity the database is
/// its own if it names a file there, or there is none.
void require_own(Connection& connection, const std::string& folder);

/// Writes the database's identity into the folder, where it is not there yet. Throws as disk_error
/// does.
void keep_identity(Connection& connection, const std::string& folder);

}  // namespace anticrack::store
