// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "postgres/database.hpp"

namespace anticrack::postgres {

/// Makes the tables in an empty database. Throws errors::Error (storage) for a schema of another
/// version.
void make_tables(Database& database);

}  // namespace anticrack::postgres
