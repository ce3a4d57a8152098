// SPDX-License-Identifier: GPL-3.0-or-later
//
// The table of answers, for people and as JSON. Pure.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "results/result.hpp"

namespace anticrack::cli {

/// Of more inclusions than this, tables tell how far they move, and not A of each.
inline constexpr std::size_t few_inclusions = 6;

/// A head row, a row of units ("-": dimensionless, or of no name), one row per load case; below it,
/// why load cases did not converge or failed. A column "A" per inclusion, with its name where there
/// are several; of one that tilts "Bx", "By", "Mx" and "My", too. Of more than few_inclusions how
/// many they are, the least and the greatest A and, if any tilts, the greatest |B|, and whose these
/// are. Of Uzawa's method the criterion that stops it, with theta; of the active set, which is
/// exact, the largest relative KKT residual.
std::string answers_table(const std::vector<results::Load>& loads, const v1::Units& units);
/// The same of a result; of a sweep how its rows ended, and what they span. Ends with the notes on
/// it.
std::string answers_table(const results::Result& result);

/// A row per load case with an answer and inclusion: A, of those that tilt B and the moment,
/// resultant and contact length; of a sweep a row per inclusion: what its rows span.
std::string inclusions_table(const results::Result& result);

/// The same as comma-separated text, numbers to full precision, what is unknown left out; of a
/// sweep sweep_csv.
std::string answers_csv(const results::Result& result);

/// Of the mesh, a sweep and each load case a row for every number: value, unit, what it is.
std::string numbers_table(const results::Result& result);

/// {title, file, job, mesh, sizes, timings, notes, answers: [one per load case]}; of a sweep also
/// {sweep: {rows, converged, ...}}, and the answers are those of the rows whose traces were kept.
std::string answers_json(const results::Result& result, const std::filesystem::path& file);

}  // namespace anticrack::cli
