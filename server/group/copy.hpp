// SPDX-License-Identifier: GPL-3.0-or-later
//
// Moves a store from a data folder with SQLite to PostgreSQL.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "postgres/pool.hpp"

namespace anticrack::group {

struct Copied {
  std::uint64_t records = 0, unfinished = 0;  ///< the latter jobs
  std::uint64_t blobs = 0, bytes = 0;         ///< triangulations, results and uploads
};

/// Copies the store in the folder `data`, which nobody may be using and store::check() must have
/// found sound, to an empty database, and reads all of it there again; all or nothing, in one
/// transaction. Jobs that have not ended go on there. O(bytes). Calls `progress` every second.
/// `dry_run`: only counts. Throws errors::Error: invalid_argument if the database has records;
/// storage.
Copied copy(const std::string& data, postgres::Pool& pool, bool dry_run,
            const std::function<void(const Copied&)>& progress);

}  // namespace anticrack::group
