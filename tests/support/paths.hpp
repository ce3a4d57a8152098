// SPDX-License-Identifier: GPL-3.0-or-later
//
// The three ways in which MeshOperator::factorise prepares a membrane.
#pragma once

#include <cstddef>

namespace anticrack::testing {

/// What `condensed_up_to` of MeshOperator::factorise asks for: 0 no dense matrix; 1 a joined
/// membrane with S^ of its contacts; more: a membrane condensed to its interfaces.
inline const char* path_name(std::size_t condensed_up_to) {
  return condensed_up_to == 0 ? "Joined" : condensed_up_to == 1 ? "Contacts" : "Dense";
}

}  // namespace anticrack::testing
