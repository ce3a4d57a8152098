// SPDX-License-Identifier: GPL-3.0-or-later
//
// The table of answers, for people and as JSON. Pure.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "results/result.hpp"

namespace anticrack::cli {

/// A head row, a row of units ("-": dimensionless), one row per load case; below it, why load cases
/// did not converge or failed. A column "A" per inclusion, with its name where there are several;
/// of one that tilts "Bx", "By", "Mx" and "My", too.
/// Of Uzawa's method the criterion that stops it, with theta; of the active set, which is exact,
/// the largest relative KKT residual.
std::string answers_table(const std::vector<results::Load>& loads);
/// The same of a result; of a sweep how its rows ended, and what they span.
std::string answers_table(const results::Result& result);

/// {title, file, job, mesh, timings, answers: [one per load case]}; of a sweep also {sweep: {rows,
/// converged, ...}}, and the answers are those of the rows whose traces were kept.
std::string answers_json(const results::Result& result, const std::filesystem::path& file);

}  // namespace anticrack::cli
