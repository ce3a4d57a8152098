// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <unordered_set>

#include "errors/placed.hpp"
#include "jobs/accuracy.hpp"
#include "jobs/growth_run.hpp"
#include "jobs/probes.hpp"
#include "jobs/sweep_check.hpp"
#include "operators/check_loads.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using errors::Reason;

constexpr std::size_t max_name_bytes = 64;

bool alphanumeric(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

/// [A-Za-z0-9][A-Za-z0-9_. -]{0,63}
bool is_name(const std::string& text) {
  return !text.empty() && text.size() <= max_name_bytes && alphanumeric(text.front()) &&
         std::all_of(text.begin(), text.end(), [](char c) {
           return alphanumeric(c) || c == '_' || c == '.' || c == ' ' || c == '-';
         });
}

std::string load_path(std::size_t load) { return fmt::format("load_cases[{}]", load); }

void check_names(const std::vector<fem::Load>& loads) {
  std::unordered_set<std::string> names;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const std::string& name = loads[i].name;
    if (!is_name(name)) {
      throw Error(Reason::invalid_argument,
                  "\"{}\" is not a name of a load case: use 1 to 64 letters, digits, '_', '.', '-' "
                  "and spaces, a letter or digit first",
                  name.substr(0, max_name_bytes))
          .at(load_path(i) + ".name");
    }
    if (!names.insert(name).second) {
      throw Error(Reason::invalid_argument,
                  "two load cases are named \"{}\": give each its own name", name)
          .at(load_path(i) + ".name");
    }
  }
}

void check_count(std::size_t loads, const EngineOptions& options) {
  if (loads == 0) {
    throw Error(Reason::invalid_argument, "the job has no load case: give at least one")
        .at("load_cases");
  }
  if (loads > static_cast<std::size_t>(options.max_load_cases)) {
    throw Error(Reason::limit_exceeded, "{} load cases: a job may have {}, so split it", loads,
                options.max_load_cases)
        .at("load_cases");
  }
}

void check_unit(const std::string& unit, const char* field) {
  constexpr std::size_t most_bytes = 16;
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  if (unit.size() > most_bytes || std::ranges::any_of(unit, is_control)) {
    throw Error(Reason::invalid_argument,
                "not the name of a unit: use at most {} bytes without control characters, as mm",
                most_bytes)
        .at(field);
  }
}

void check_balanced_flux(const records::JobSpec& spec) {
  if (!spec.sweep && !spec.growth && !spec.without_bounds &&
      std::holds_alternative<contact::ActiveSetOptions>(spec.solver))
    return;
  throw Error(Reason::invalid_argument,
              "the balanced flux is that of bounds, which {}: leave it out",
              spec.sweep            ? "rows of a sweep do not keep"
              : spec.growth         ? "growth does not have"
              : spec.without_bounds ? "are not wanted here"
                                    : "Algorithm 2 does not have")
      .at("outputs");
}

}  // namespace

void check(const records::JobSpec& spec, const EngineOptions& options) {
  if (spec.sweep)
    check_sweep(spec, options);
  else
    check_count(spec.loads.size(), options);
  if (spec.accuracy) check_accuracy(spec);
  if (spec.growth) check_growth(spec, options);
  if (spec.balanced_flux) check_balanced_flux(spec);
  if (spec.units) {
    check_unit(spec.units->length, "units.length");
    check_unit(spec.units->force, "units.force");
  }
  check_names(spec.loads);
  check_probes(spec.probes);
  for (std::size_t i = 0; i < spec.loads.size(); ++i)
    errors::below(load_path(i), [&] { fem::check(spec.loads[i], options.max_expression_bytes); });
  errors::below("solver", [&] { contact::check(spec.solver, options.max_iterations); });
}

void check_on_mesh(const records::JobSpec& spec, const records::MeshDefinition& definition) {
  if (const auto* made = std::get_if<records::GeometrySource>(&definition))
    operators::check_loads(spec.loads, made->geometry);
  if (const auto* file = std::get_if<records::UploadRef>(&definition))
    operators::check_loads(spec.loads, file->options.inclusion_motions);
}

}  // namespace anticrack::jobs
