// SPDX-License-Identifier: GPL-3.0-or-later
//
// Triangulations, results and uploads in PostgreSQL: rows of 1 MiB pieces under the blob's name. A
// blob is written in the transaction of the row that refers to it, and removed in that of the last
// row that did, so none is ever without the other.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "postgres/pool.hpp"
#include "store/disk_usage.hpp"

namespace anticrack::group {

constexpr std::uint64_t piece_bytes = std::uint64_t{1} << 20U;

using ReadBytes = std::function<void(std::uint64_t offset, std::span<std::byte> bytes)>;

/// Writes the `size` bytes that read(offset, bytes) gives, also where the blob is there already: it
/// may be damaged. Holds its row until the transaction ends.
void write_blob(postgres::Transaction& transaction, store::FileKind kind, const std::string& name,
                std::uint64_t size, const ReadBytes& read);

/// Removes those of the blobs to which no row refers; returns their names. Empty names are none.
std::vector<std::string> remove_unreferenced(postgres::Transaction& transaction,
                                             std::vector<std::string> names);

/// Holds the rows of these uploads until the transaction ends, so that none of them expires unseen:
/// for a row that needs them. Those that are not there are left out.
void hold_uploads(postgres::Transaction& transaction, const std::string& owner,
                  const std::vector<std::string>& uploads);

/// Calls take(bytes) for the pieces in order. Returns the size; 0 if there is no such blob. Throws
/// errors::Error (storage) if a piece is missing.
std::uint64_t read_blob(postgres::Pool& pool, store::FileKind kind, const std::string& name,
                        const std::function<void(std::span<const std::byte>)>& take);

/// SQL: whether no row refers to the blob b.
extern const char* const unreferenced;

/// Reads parts of a blob of `size` bytes, of which piece(n) is a row with its n-th piece, and no
/// row where there is none; keeps one. Calls from several threads wait for one another. Throws
/// errors::Error (result_expired) if it was removed meanwhile.
ReadBytes reader_of_pieces(std::function<postgres::Result(std::uint64_t n)> piece,
                           const std::string& name, std::uint64_t size);
/// The same of a blob in the database.
ReadBytes reader_of_blob(postgres::Pool& pool, const std::string& name, std::uint64_t size);

}  // namespace anticrack::group
