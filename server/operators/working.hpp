// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstddef>

namespace anticrack::operators {

/// Counts memory that is taken for a while in MeshOperator::bytes(); made before it is taken.
class Working {
 public:
  Working(std::atomic<std::size_t>& sum, std::size_t bytes) : _sum(sum), _bytes(bytes) {
    _sum += _bytes;
  }
  ~Working() { _sum -= _bytes; }
  Working(const Working&) = delete;
  Working& operator=(const Working&) = delete;

 private:
  std::atomic<std::size_t>& _sum;
  const std::size_t _bytes;
};

}  // namespace anticrack::operators
