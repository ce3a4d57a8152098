// SPDX-License-Identifier: GPL-3.0-or-later
//
// Looking at all of a store that no server has open, and making it sound.
#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "store/disk_usage.hpp"

namespace anticrack::store {

struct CheckedStore {
  using Name = std::pair<FileKind, std::string>;

  std::size_t records = 0;         ///< that were read
  std::size_t files = 0;           ///< meshes, results and uploads
  std::vector<std::string> flaws;  ///< what is wrong, a line each; none: it is sound

  // What repair() goes by:
  bool has_database = false;  ///< one that can be opened
  std::set<Name> damaged;     ///< records, by id
  std::set<Name> lost;        ///< files that are damaged or not there
  std::set<Name> spare;       ///< files that are damaged or belong to no record
};

/// Reads every record and every file, O(bytes in the folder), and changes nothing. Throws
/// errors::Error (storage) where the disk refuses, or the database is not of this version.
CheckedStore check(const std::string& folder);

/// Takes what is flawed out of the store, into a new folder below its own, which it returns: files
/// that are damaged or belong to no record, and a copy of the database, from which go the records
/// that are damaged or have lost their file. Throws errors::Error (storage) where the disk refuses,
/// and where the database is damaged beyond its records.
std::string repair(const std::string& folder, const CheckedStore& checked);

}  // namespace anticrack::store
