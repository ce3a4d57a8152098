// SPDX-License-Identifier: GPL-3.0-or-later
//
// The stages of a job with an accuracy, as text. Pure.
#pragma once

#include <string>

#include "results/result.hpp"

namespace anticrack::cli {

/// A row for each stage of the load: its triangles, the energy and its bounds, the error of u in
/// the energy norm and, if it is known, that of A. Empty if there are no stages.
std::string stages_table(const results::Load& load);

}  // namespace anticrack::cli
