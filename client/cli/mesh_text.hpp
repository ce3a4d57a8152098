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
  results::Units units{};
  bool free = false;  ///< no load gives a traction
};

/// State and sizes; subdomains; interfaces by segments; tips; conditions on the boundary; warnings.
std::string mesh_text(const v1::Mesh& mesh, const CaseFacts& facts = {});

/// A law as text: an expression, or "along 2, across 1, angle 30". May have control characters.
std::string law_text(const v1::Tension& law);

}  // namespace anticrack::cli
