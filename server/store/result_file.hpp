// SPDX-License-Identifier: GPL-3.0-or-later
//
// A result on the disk: magic and version (8 bytes), length of the header and its CRC-32C (4 bytes
// each), the header (BlockLayout of the API: layout, length and hash of the bytes), the bytes.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "records/block.hpp"
#include "store/files.hpp"

namespace anticrack::store {

/// All that comes before the bytes of a block. Throws std::length_error for a layout beyond 16 MB.
std::string result_header(const records::BlockSource& block);
/// The name of a result: the hash of such a header, which includes the hash of the bytes.
std::string name_of_result(const std::string& header);

/// The result in a file, which it keeps open. Throws errors::Error (storage) if it is no result, or
/// not the one of this name; the bytes are not read.
std::shared_ptr<const records::BlockSource> open_result(base::Descriptor file,
                                                        const std::string& path,
                                                        const std::string& name);
/// The same for the content of such a file in memory. `place`: for messages.
std::shared_ptr<const records::BlockSource> open_result(std::string stored,
                                                        const std::string& place);
/// The same for `size` bytes that read(offset, bytes) gives; those of the block are not read.
std::shared_ptr<const records::BlockSource> open_result(
    std::function<void(std::uint64_t offset, std::span<std::byte> bytes)> read, std::uint64_t size,
    const std::string& place);
/// Reads all bytes. Throws errors::Error (storage) if they do not have their hash.
void require_whole(const records::BlockSource& block, const std::string& place);

}  // namespace anticrack::store
