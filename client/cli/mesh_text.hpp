// SPDX-License-Identifier: GPL-3.0-or-later
//
// A mesh as the server understood it, as tables for users. Pure.
#pragma once

#include <string>

#include "anticrack/v1/mesh.pb.h"
#include "results/result.hpp"

namespace anticrack::cli {

/// Facts about a mesh that only its case tells; of a mesh given by its name nothing is known.
struct CaseFacts {
  v1::Units units{};
  bool free = false;  ///< no load gives a traction
};

/// State and sizes; subdomains; interfaces by segments; tips; conditions on the boundary; warnings.
std::string mesh_text(const v1::Mesh& mesh, const CaseFacts& facts = {});

}  // namespace anticrack::cli
