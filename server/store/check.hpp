// SPDX-License-Identifier: GPL-3.0-or-later
//
// Checks all of a store that no server has open, and makes it sound.
#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "store/disk_usage.hpp"

namespace anticrack::store {

struct CheckedStore {
  using Name = std::pair<FileKind, std::string>;

  std::size_t records = 0;         ///< records that were read
  std::size_t files = 0;           ///< meshes, results and uploads
  std::vector<std::string> flaws;  ///< the faults, a line each; empty: the store is sound

  // Used by repair():
  bool has_database = false;  ///< there is one that can be opened
  std::set<Name> damaged;     ///< records, by id
  std::set<Name> lost;        ///< files that are damaged or missing
  std::set<Name> spare;       ///< files that are damaged or belong to no record
};

/// Reads every record and every file, O(bytes in the folder), and changes nothing. Throws
/// errors::Error (storage) if the disk refuses, or the database is not of this version.
CheckedStore check(const std::string& folder);

/// Moves the flawed parts of the store into a new folder below its own, which it returns: files
/// that are damaged or belong to no record, and a copy of the database, from which the records that
/// are damaged or have lost their file are then removed. Throws errors::Error (storage) if the disk
/// refuses, or if the database is damaged beyond its records.
std::string repair(const std::string& folder, const CheckedStore& checked);

}  // namespace anticrack::store
