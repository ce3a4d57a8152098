// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the server tells, as tables and sentences for users, as JSON and as comma-separated text.
// Pure.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "anticrack/v1/mesh.pb.h"
#include "anticrack/v1/solve.pb.h"
#include "results/entries.hpp"
#include "results/result.hpp"

namespace anticrack::cli {

/// With more inclusions than this, tables show the range of their motions instead of each A.
inline constexpr std::size_t few_inclusions = 6;

/// A head row, a row of units ("-": dimensionless, or without a name) and one row per load case;
/// below the table, why load cases did not converge or failed, tips and growth.
std::string answers_table(const std::vector<results::Load>& loads, const v1::Units& units);
/// The same for a result; for a sweep how its rows ended, and their ranges. Ends with the notes on
/// the result.
std::string answers_table(const results::Result& result);

/// A row per load case with an answer and inclusion; for a sweep one per inclusion, with ranges.
std::string inclusions_table(const results::Result& result);

/// The same as comma-separated text, with numbers to full precision and unknown values left out;
/// for a sweep sweep_csv.
std::string answers_csv(const results::Result& result);

/// Of the mesh, a sweep and each load case a row for every number: value, unit, what it is.
std::string numbers_table(const results::Result& result);

/// All of a result but arrays; of a sweep the answers are those of the rows whose traces were kept.
std::string answers_json(const results::Result& result, const std::filesystem::path& file);

/// The text below the answers: what was reached on which mesh, and what was not and why. Empty for
/// a job without accuracy.
std::string accuracy_text(const v1::Job& job);

/// A value of a message as text; "-" for a number that is not set.
std::string text_of(const results::Value& value);

/// A row for each message of the list `name` of each load's answer, with all its values.
std::string list_table(const results::Result& result, const char* name);

/// A row for each tip of each load, and a line for each reason why numbers are missing. Empty where
/// there are no tips; of many, unless `all`, a line that says how to see them.
std::string tips_table(const std::vector<results::Load>& loads, const v1::Units& units, bool all);

/// A row for each position of fronts that grow, and what happens in words; empty without growth. Of
/// many rows, unless `all` are asked for, those where something begins: the first, those before and
/// after jumps, and the last.
std::string growth_table(const std::vector<results::Load>& loads, const v1::Units& units, bool all);

/// A row for each stage of the load; empty if there are none.
std::string stages_table(const results::Load& load);

/// The most steps and the largest residual of the rows that converged.
std::string worst_of(const v1::SweepAnswer& answer);

/// How rows ended, the ranges of their numbers, and how wide the bounds are. With bounds, the
/// ranges of A and of the energy contain the exact values of the membrane.
std::string sweep_table(const results::Sweep& sweep, const v1::Units& units);

/// The range of A of every inclusion, and of B of those that tilt.
std::string sweep_inclusions(const results::Sweep& sweep, const v1::Units& units);

nlohmann::ordered_json sweep_json(const results::Sweep& sweep);  ///< the same as JSON

/// A line per row; numbers have full precision, and those of a row that did not converge are left
/// out. O(size of the sweep).
std::string sweep_csv(const results::Sweep& sweep);

/// Facts about a mesh that only its case tells; of a mesh given by its name nothing is known.
struct CaseFacts {
  v1::Units units{};
  bool free = false;  ///< no load gives a traction
};

/// What the server tells of a mesh, in words and tables.
std::string mesh_text(const v1::Mesh& mesh, const CaseFacts& facts = {});

/// What the server tells of a job: also the answers so far, and the times of its steps.
std::string job_text(const v1::Job& job);

/// A text that says that the results of a job were removed, and what to do.
std::string expired_text(const v1::Job& job);

/// The requests that a job which has ended did not fulfil, line by line; empty if there are none.
/// `told`: gives the text of an error.
std::vector<std::string> shortfalls(
    const v1::Job& job,
    const std::function<std::string(const v1::Status&)>& told = &v1::Status::message);

}  // namespace anticrack::cli
