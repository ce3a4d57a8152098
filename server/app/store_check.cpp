// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/store_check.hpp"

#include <filesystem>
#include <ostream>

#include "app/data_folder.hpp"
#include "errors/errors.hpp"
#include "store/check.hpp"

namespace anticrack::app {

int check_store(const Config& config, bool repair, std::ostream& out) {
  constexpr int flawed = 3;
  if (!config.store.url.empty())
    throw ConfigError("check-store: --store is a database: check it with pg_amcheck");
  const std::string& data = config.store.folder;
  if (!std::filesystem::is_directory(data)) {
    throw ConfigError("data-dir: " + data +
                      " is not a folder: give the data folder with --data-dir");
  }
  const DataFolder held(data);
  const store::CheckedStore found = store::check(data);
  for (const std::string& flaw : found.flaws) out << flaw << "\n";
  out << data << ": " << found.records << " records, " << found.files << " files, "
      << found.flaws.size() << " flaws\n";
  if (found.flaws.empty()) return 0;
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

}  // namespace anticrack::app
