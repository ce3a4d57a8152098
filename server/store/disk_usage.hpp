// SPDX-License-Identifier: GPL-3.0-or-later
//
// How many bytes the store's files take, and whether more fit.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>

namespace anticrack::store {

enum class FileKind { mesh, result, upload };
constexpr std::array file_kinds{FileKind::mesh, FileKind::result, FileKind::upload};

/// Thread-safe; the lock is held for additions only.
class DiskUsage {
 public:
  /// `budget`: bytes; 0: no limit.
  explicit DiskUsage(std::uint64_t budget) : _budget(budget) {}
  DiskUsage(const DiskUsage&) = delete;
  DiskUsage& operator=(const DiskUsage&) = delete;

  /// Adds the bytes of files that came, or subtracts those of files that went.
  void add(FileKind kind, std::uint64_t bytes);
  void remove(FileKind kind, std::uint64_t bytes);
  /// The bytes of the files of a kind, without reservations.
  std::uint64_t bytes(FileKind kind) const;

  /// Bytes that are about to be written, counted until this goes out of scope. Keep it until the
  /// written bytes have been added.
  class Reservation {
   public:
    Reservation(DiskUsage& usage, std::uint64_t bytes) : _usage(&usage), _bytes(bytes) {}
    Reservation(Reservation&& other) noexcept : _usage(other._usage), _bytes(other._bytes) {
      other._usage = nullptr;
    }
    Reservation& operator=(Reservation&&) = delete;
    ~Reservation();

   private:
    DiskUsage* _usage;
    std::uint64_t _bytes;
  };
  /// Reserves bytes. Throws errors::Error (disk_full) if `bytes` more do not fit; `others` are
  /// bytes that are not counted here (the database).
  Reservation reserve(std::uint64_t bytes, std::uint64_t others);

 private:
  const std::uint64_t _budget;
  mutable std::mutex _mutex;
  std::array<std::uint64_t, file_kinds.size()> _bytes{};
  std::uint64_t _reserved = 0;
};

}  // namespace anticrack::store
