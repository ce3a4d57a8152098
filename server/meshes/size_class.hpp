// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace anticrack::meshes {

/// Meshes of about one size: a factor of four, and all below 4,096 triangles. What is done with a
/// mesh waits for others of its class alone, so that large meshes hold up no small one.
constexpr int size_class(std::uint64_t triangles) noexcept {
  return static_cast<int>(std::bit_width(std::max<std::uint64_t>(triangles, 4095)) - 1) / 2;
}

}  // namespace anticrack::meshes
