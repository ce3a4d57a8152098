// SPDX-License-Identifier: GPL-3.0-or-later
//
// A copy of a store, while a server may use it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace anticrack::store {

struct BackedUp {
  std::string folder;
  std::size_t files = 0;    ///< meshes, results and uploads
  std::uint64_t bytes = 0;  ///< bytes of the files and of the database
};

/// Makes the folder `to`, a data folder with the records of one moment and every file to which they
/// refer. Files never change, so they are hard links, or copies if `to` is on another file system.
/// `to` appears when it is complete and on the disk. O(size of the database and number of files).
/// Throws errors::Error: invalid_argument if `to` exists or `data` holds no store; storage if the
/// disk refuses, the database is of another version, or a file to which a record refers is missing.
BackedUp back_up(const std::string& data, const std::string& to);

}  // namespace anticrack::store
