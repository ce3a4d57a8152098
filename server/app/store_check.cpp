// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/store_check.hpp"

#include <chrono>
#include <filesystem>
#include <ostream>

#include "app/data_folder.hpp"
#include "errors/errors.hpp"
#include "group/check.hpp"
#include "group/copy.hpp"
#include "group/store.hpp"
#include "store/backup.hpp"
#include "store/check.hpp"
#include "store/files.hpp"

namespace anticrack::app {

namespace {

constexpr int flawed = 3;

/// Prints what a check found; returns whether all is sound.
bool tell(const std::string& place, const char* files, const store::CheckedStore& found,
          std::ostream& out) {
  for (const std::string& flaw : found.flaws) out << flaw << "\n";
  out << place << ": " << found.records << " records, " << found.files << " " << files << ", "
      << found.flaws.size() << " flaws\n";
  return found.flaws.empty();
}

/// How to reach the database of --store.
postgres::Settings database_of(const Config& config) {
  try {
    return group::settings_of(config.store.url);
  } catch (const errors::Error& error) {
    throw ConfigError(std::string("store: ") + error.what());
  }
}

}  // namespace

int check_store(const Config& config, bool repair, std::ostream& out) {
  if (!config.store.url.empty()) {
    if (repair)
      throw ConfigError("repair: --store is a database: restore a backup (pg_restore) instead");
    postgres::Pool pool(database_of(config));
    return tell(pool.settings().address.shown(), "blobs", group::check(pool), out) ? 0 : flawed;
  }
  const std::string& data = config.store.folder;
  if (!std::filesystem::is_directory(data)) {
    throw ConfigError("data-dir: " + data +
                      " is not a folder: give the data folder with --data-dir");
  }
  const DataFolder held(data);
  const store::CheckedStore found = store::check(data);
  if (tell(data, "files", found, out)) return 0;
  if (!repair) {
    out << "Nothing was changed: restore a backup, or move the flawed records and files aside with "
           "--repair.\n";
    return flawed;
  }
  const std::string aside = store::repair(data, found);
  if (const store::CheckedStore left = store::check(data); !left.flaws.empty()) {
    throw errors::Error(errors::Reason::storage,
                        "the store cannot be repaired, restore a backup: {}", left.flaws.front());
  }
  out << "The rest is sound. The damaged parts and a copy of the database are in " << aside << "\n";
  return 0;
}

int copy_store(const Config& config, bool dry_run, std::ostream& out) {
  const std::string& data = config.store.folder;
  if (config.store.url.empty())
    throw ConfigError("copy-store: say where to, with --store postgresql://USER@HOST/DATABASE");
  if (!store::file_size(store::database_path(data)))
    throw ConfigError("data-dir: " + data + " has no database: give a data folder with --data-dir");
  postgres::Pool pool(database_of(config));
  const DataFolder held(data);
  if (!tell(data, "files", store::check(data), out)) {
    out << "Nothing was copied: restore a backup, or see --check-store --repair.\n";
    return flawed;
  }
  group::require_empty(pool);
  const std::string& to = pool.settings().address.shown();
  if (dry_run) {
    out << "All of this would be copied to " << to << ", which is empty.\n";
    return 0;
  }
  using Clock = std::chrono::steady_clock;
  Clock::time_point next = Clock::now() + std::chrono::seconds(1);
  group::copy(data, pool, [&](std::size_t records, std::uint64_t bytes) {
    if (Clock::now() < next) return;
    next = Clock::now() + std::chrono::seconds(1);
    out << "copied " << records << " records, " << bytes << " bytes" << std::endl;
  });
  out << "All of this is in " << to << " now, and was read there again.\n";
  return 0;
}

int back_up(const Config& config, const std::string& to, std::ostream& out) {
  if (!config.store.url.empty())
    throw ConfigError(
        "backup: --store is a database: back it up with pg_dump --format=custom "
        "--schema=anticrack");
  const store::BackedUp made = store::back_up(config.store.folder, to);
  out << made.folder << ": " << made.files << " files, " << made.bytes
      << " bytes, and the database; it is a data folder itself\n";
  return 0;
}

}  // namespace anticrack::app
