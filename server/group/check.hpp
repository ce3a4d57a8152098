// SPDX-License-Identifier: GPL-3.0-or-later
//
// Checks all of a store in PostgreSQL, of which servers may be running.
#pragma once

#include "postgres/pool.hpp"
#include "store/check.hpp"

namespace anticrack::group {

/// Reads every record and every piece in one snapshot, O(bytes in the database), and changes
/// nothing. `files` are blobs, and only `flaws` tells of faults. Throws errors::Error (storage) if
/// the database cannot be reached or has no store of this version.
store::CheckedStore check(postgres::Pool& pool);

/// The same as the transaction sees it.
store::CheckedStore check(postgres::Transaction& transaction);

}  // namespace anticrack::group
