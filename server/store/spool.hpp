// SPDX-License-Identifier: GPL-3.0-or-later
//
// The bytes of a result while its job runs.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "records/block.hpp"
#include "store/disk_usage.hpp"
#include "store/files.hpp"

namespace anticrack::store {

/// Grows by pieces: the last megabyte is in memory, the rest in a file without a name, which
/// disappears with this object or with the process. Bytes that the disk refuses stay in memory
/// until the disk takes them. Thread-safe.
class Spool {
 public:
  /// The place of a piece.
  struct Run {
    std::uint64_t place = 0;
    std::uint64_t bytes = 0;
  };

  /// `open` makes the file, `reserve` counts its bytes; both may throw errors::Error.
  Spool(std::function<base::Descriptor()> open,
        std::function<DiskUsage::Reservation(std::uint64_t bytes)> reserve);

  Run append(std::span<const std::byte> bytes);
  /// Fills `bytes` with those from a place on. Throws errors::Error (storage).
  void read(std::uint64_t place, std::span<std::byte> bytes) const;
  /// The bytes that are in memory now.
  std::size_t memory() const noexcept { return _held; }

 private:
  void write_out();

  const std::function<base::Descriptor()> _open;
  const std::function<DiskUsage::Reservation(std::uint64_t)> _reserve;
  mutable std::mutex _mutex;
  std::optional<base::Descriptor> _file;
  std::uint64_t _written = 0;         ///< bytes in the file; those after it are in memory
  std::vector<std::byte> _memory;     ///< from place _written on
  std::atomic<std::size_t> _held{0};  ///< size of _memory, readable without the lock
  std::vector<DiskUsage::Reservation> _reserved;
};

/// A block whose arrays lie in a spool.
class SpooledBlock {
 public:
  explicit SpooledBlock(std::shared_ptr<const Spool> spool);

  /// Adds an array that consists of runs, one after the other.
  void add(std::string name, records::ArrayType type, std::vector<std::uint64_t> shape,
           std::span<const Spool::Run> runs);
  /// Adds the arrays of a block whose bytes are the run.
  void add(std::span<const records::ArrayLayout> arrays, const Spool::Run& run);
  /// Reads all bytes for the hash. Throws errors::Error (storage). The object is empty afterwards.
  std::shared_ptr<const records::BlockSource> finish();

 private:
  class Source;
  std::shared_ptr<Source> _source;
};

}  // namespace anticrack::store
