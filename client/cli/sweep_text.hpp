// SPDX-License-Identifier: GPL-3.0-or-later
//
// The answers of a sweep for users, for scripts and for spreadsheets. Pure.
#pragma once

#include <string>

#include "cli/json.hpp"
#include "results/result.hpp"

namespace anticrack::cli {

/// How many rows ended in which way, the ranges of A, contact length and energy, what went wrong,
/// and how wide the bounds are. With bounds, the ranges of A and of the energy contain the exact
/// values of the membrane. For many inclusions there is one range, with the inclusions at its ends.
std::string sweep_table(const results::Sweep& sweep, const v1::Units& units);

/// The range of A of every inclusion, and of B of those that tilt.
std::string sweep_inclusions(const results::Sweep& sweep, const v1::Units& units);

Json sweep_json(const results::Sweep& sweep);  ///< the same as JSON

/// A line per row: row, coefficients by the names of their loads, A per inclusion, energy,
/// contact_length, steps, status; bounds stand beside their numbers. Numbers have full precision;
/// those of a row that did not converge are left out. O(size of the sweep).
std::string sweep_csv(const results::Sweep& sweep);

}  // namespace anticrack::cli
