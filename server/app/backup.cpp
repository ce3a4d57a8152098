// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/backup.hpp"

#include <sys/stat.h>

#include <ostream>

#include "store/backup.hpp"

namespace anticrack::app {

int back_up(const Config& config, const std::string& to, std::ostream& out) {
  if (!config.store.url.empty())
    throw ConfigError(
        "backup: --store is a database: back it up with pg_dump --format=custom "
        "--schema=anticrack");
  ::umask(0077);
  const store::BackedUp made = store::back_up(config.store.folder, to);
  out << made.folder << ": " << made.files << " files, " << made.bytes
      << " bytes, and the database; it is a data folder itself\n";
  return 0;
}

}  // namespace anticrack::app
