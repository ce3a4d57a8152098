// SPDX-License-Identifier: GPL-3.0-or-later
//
// The answers of a sweep for people, for scripts and for spreadsheets. Pure.
#pragma once

#include <string>

#include "cli/json.hpp"
#include "results/result.hpp"

namespace anticrack::cli {

/// How many rows ended how, the span of A, contact length and energy, and what went wrong; how wide
/// the bounds are. With bounds the spans of A and the energy hold those of the membrane itself. Of
/// many inclusions one span, and whose its ends are.
std::string sweep_table(const results::Sweep& sweep, const v1::Units& units);

/// The span of A of every inclusion, and of B of those that tilt.
std::string sweep_inclusions(const results::Sweep& sweep, const v1::Units& units);

Json sweep_json(const results::Sweep& sweep);  ///< the same

/// A line per row: row, coefficients by the names of their loads, A per inclusion, energy,
/// contact_length, steps, status; bounds beside what they are of. Numbers to full precision; those
/// of a row that did not converge are left out. O(size of the sweep).
std::string sweep_csv(const results::Sweep& sweep);

}  // namespace anticrack::cli
