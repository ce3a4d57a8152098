// SPDX-License-Identifier: GPL-3.0-or-later
//
// A mesh as the server understood it, as tables for people. Pure.
#pragma once

#include <string>

#include "anticrack/v1/mesh.pb.h"

namespace anticrack::cli {

/// State and sizes; subdomains; interfaces by segments; tips; what holds on the boundary; warnings.
std::string mesh_text(const v1::Mesh& mesh);
/// An expression, or "along 2, across 1, angle 30". May have control characters.
std::string law_text(const v1::Tension& law);

}  // namespace anticrack::cli
