// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace anticrack::meshes {

/// Classes of mesh sizes: each covers a factor of four, the first everything below 4,096 triangles.
/// Work on a mesh waits only for meshes of its class, so that large meshes do not delay small ones.
constexpr int size_class(std::uint64_t triangles) noexcept {
  return static_cast<int>(std::bit_width(std::max<std::uint64_t>(triangles, 4095)) - 1) / 2;
}

}  // namespace anticrack::meshes
