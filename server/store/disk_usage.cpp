// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/disk_usage.hpp"

#include <fmt/core.h>

#include <numeric>
#include <string>

#include "store/disk_errors.hpp"

namespace anticrack::store {

void DiskUsage::add(FileKind kind, std::uint64_t bytes) {
  const std::lock_guard lock(_mutex);
  _bytes[static_cast<std::size_t>(kind)] += bytes;
}

void DiskUsage::remove(FileKind kind, std::uint64_t bytes) {
  const std::lock_guard lock(_mutex);
  _bytes[static_cast<std::size_t>(kind)] -= bytes;
}

std::uint64_t DiskUsage::bytes(FileKind kind) const {
  const std::lock_guard lock(_mutex);
  return _bytes[static_cast<std::size_t>(kind)];
}

DiskUsage::Reservation DiskUsage::reserve(std::uint64_t bytes, std::uint64_t others) {
  const std::lock_guard lock(_mutex);
  const std::uint64_t used =
      std::accumulate(_bytes.begin(), _bytes.end(), std::uint64_t{0}) + _reserved + others;
  if (_budget > 0 && (used > _budget || bytes > _budget - used)) {
    throw disk_full(
        fmt::format("{} bytes more do not fit into the disk budget of {}, of which {} are used",
                    bytes, _budget, used));
  }
  Reservation reservation(*this, bytes);
  _reserved += bytes;
  return reservation;
}

DiskUsage::Reservation::~Reservation() {
  if (_usage != nullptr) {
    const std::lock_guard lock(_usage->_mutex);
    _usage->_reserved -= _bytes;
  }
}

}  // namespace anticrack::store
