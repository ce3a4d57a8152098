// SPDX-License-Identifier: GPL-3.0-or-later
//
// The tables of the database and their version. All are in the schema `anticrack`.
#pragma once

#include <span>
#include <string>

#include "postgres/pool.hpp"

namespace anticrack::postgres {

/// What makes the tables. `steps`: SQL that leads from each version to the next; the last step
/// leads to the version of this program. `oldest`: the oldest version whose programs can work on
/// the tables of the last one, so that servers of two versions may run while they are being
/// replaced.
struct Tables {
  std::span<const char* const> steps;
  int oldest = 1;
};

/// Makes the tables, or takes those of an older version to this one, in one transaction; several
/// servers may call it at once. Throws errors::Error (storage) where the tables are those of a
/// newer version with which this program cannot work, and as transact() does.
void make_tables(Pool& pool, const Tables& tables);

}  // namespace anticrack::postgres
