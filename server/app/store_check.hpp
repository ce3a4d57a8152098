// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <iosfwd>
#include <string>

#include "app/config.hpp"

namespace anticrack::app {

/// Implements --check-store: prints the flaws of the data folder or database, one per line, and
/// with `repair` moves those of a folder aside. Returns the exit code: 0 if the store is sound
/// (after a repair), else 3. Throws ConfigError if a server uses the folder or it does not exist,
/// and as store::check() and store::repair() do.
int check_store(const Config& config, bool repair, std::ostream& out);

/// Implements --copy-store: copies the data folder to the database of --store, or (`dry_run`) says
/// what it would copy. Returns 0, or 3 where the folder has flaws. Throws ConfigError if a server
/// uses the folder, and as group::copy() does.
int copy_store(const Config& config, bool dry_run, std::ostream& out);

/// Implements --backup: copies the data folder to the new folder `to`, while a server may serve it,
/// and prints what was copied. Returns 0. Throws as store::back_up() does.
int back_up(const Config& config, const std::string& to, std::ostream& out);

}  // namespace anticrack::app
