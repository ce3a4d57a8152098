// SPDX-License-Identifier: GPL-3.0-or-later
//
// Signed indices (std::int32_t of meshes, Eigen::Index) as std::size_t of containers:
// values[at(i)].
#pragma once

#include <concepts>
#include <cstddef>

namespace anticrack {

/// `i` >= 0 as an index of a container; not checked.
template <std::signed_integral Index>
constexpr std::size_t at(Index i) noexcept {
  return static_cast<std::size_t>(i);
}

}  // namespace anticrack
