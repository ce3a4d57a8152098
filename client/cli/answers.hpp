// SPDX-License-Identifier: GPL-3.0-or-later
//
// The table of answers, as text and as JSON. Pure.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "results/result.hpp"

namespace anticrack::cli {

/// With more inclusions than this, tables show the range of their motions instead of each A.
inline constexpr std::size_t few_inclusions = 6;

/// A head row, a row of units ("-": dimensionless, or without a name) and one row per load case;
/// below the table, why load cases did not converge or failed. There is a column "A" per inclusion,
/// with its name if there are several; for one that tilts also "Bx", "By", "Mx" and "My". For more
/// than few_inclusions there are their number, the least and the greatest A and, if any tilts, the
/// greatest |B|, with the names of these inclusions. For Uzawa's method there are the criterion
/// that stops it, and theta; for the active set, which is exact, the largest relative KKT residual.
std::string answers_table(const std::vector<results::Load>& loads, const v1::Units& units);
/// The same for a result; for a sweep how its rows ended, and their ranges. Ends with the notes on
/// the result.
std::string answers_table(const results::Result& result);

/// A row per load case with an answer and inclusion: A, for those that tilt also B and the moment,
/// resultant and contact length. For a sweep a row per inclusion with the ranges of its rows.
std::string inclusions_table(const results::Result& result);

/// The same as comma-separated text, with numbers to full precision and unknown values left out;
/// for a sweep sweep_csv.
std::string answers_csv(const results::Result& result);

/// Of the mesh, a sweep and each load case a row for every number: value, unit, what it is.
std::string numbers_table(const results::Result& result);

/// {title, file, job, mesh, sizes, timings, notes, answers: [one per load case]}; for a sweep also
/// {sweep: {rows, converged, ...}}, and the answers are those of the rows whose traces were kept.
std::string answers_json(const results::Result& result, const std::filesystem::path& file);

}  // namespace anticrack::cli
