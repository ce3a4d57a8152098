// SPDX-License-Identifier: GPL-3.0-or-later
//
// The mesh of the preset `paper`, made by the real helper; compile with ANTICRACK_MESHER set to its
// path and link anticrack_mesher.
#pragma once

#include <memory>

#include "mesher/helper.hpp"
#include "support/paper_geometry.hpp"

namespace anticrack::testing {

/// Made once a process.
inline std::shared_ptr<const mesh::Mesh> paper_mesh() {
  static const auto mesh = [] {
    mesher::HelperOptions options;
    options.executable = ANTICRACK_MESHER;
    constexpr std::size_t limit = 100'000;
    return std::make_shared<const mesh::Mesh>(mesher::run(
        options, mesh::GenerateRequest{mesh::plan(paper_geometry(), paper_options(), limit), limit},
        {}));
  }();
  return mesh;
}

/// Section 8: the forces of Examples 1 to 4.
inline constexpr const char* paper_forces[] = {"1", "x*y < 0 ? -1 : 1", "y > 0 ? 1 : -1",
                                               "x < 0 ? 1 : -1"};

}  // namespace anticrack::testing
