// SPDX-License-Identifier: GPL-3.0-or-later
//
// Signed numbers as places in arrays: meshes count in std::int32_t and matrices in Eigen::Index,
// while containers want std::size_t. `values[at(i)]` says that i is not negative.
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
