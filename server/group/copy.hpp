// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "postgres/pool.hpp"

namespace anticrack::group {

/// Throws errors::Error (invalid_argument) if the database has records.
void require_empty(postgres::Pool& pool);

/// Copies the store in the folder `data`, which nobody may be using and store::check() must have
/// found sound, to an empty database, and reads all of it there again; all or nothing, in one
/// transaction. Jobs that have not ended go on there. O(bytes). Calls progress(records, bytes so
/// far) after each record. Throws as require_empty() does, and errors::Error (storage).
void copy(const std::string& data, postgres::Pool& pool,
          const std::function<void(std::size_t, std::uint64_t)>& progress);

}  // namespace anticrack::group
