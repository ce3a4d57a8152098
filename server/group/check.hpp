// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "postgres/pool.hpp"
#include "store/check.hpp"

namespace anticrack::group {

/// Reads every record and every piece in one snapshot, while servers may be running. O(bytes).
/// `files` are blobs; of the faults it has only `flaws`. Throws errors::Error (storage) if the
/// database cannot be reached or has no store of this version.
store::CheckedStore check(postgres::Pool& pool);
/// The same as the transaction sees it.
store::CheckedStore check(postgres::Transaction& transaction);

}  // namespace anticrack::group
