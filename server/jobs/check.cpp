// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/check.hpp"

#include <algorithm>
#include <unordered_set>
#include <variant>

#include "errors/errors.hpp"
#include "store/canonical.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using errors::Reason;

constexpr std::size_t max_title_bytes = 200;
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

std::string path_of(std::size_t load) {
  return "load_cases[" + std::to_string(load) + "]";
}

void check_names(const std::vector<fem::Load>& loads) {
  std::unordered_set<std::string> names;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const std::string& name = loads[i].name;
    if (!is_name(name)) {
      throw Error(Reason::invalid_argument,
                  "\"" + name.substr(0, max_name_bytes) +
                      "\" is no name of a load case: use 1 to 64 letters, digits, '_', '.', '-' "
                      "and spaces, a letter or digit first")
          .at(path_of(i) + ".name");
    }
    if (!names.insert(name).second) {
      throw Error(Reason::invalid_argument,
                  "two load cases are named \"" + name + "\": give each its own name")
          .at(path_of(i) + ".name");
    }
  }
}

}  // namespace

void check(const store::JobSpec& spec, const EngineOptions& options) {
  if (spec.title.size() > max_title_bytes) {
    throw Error(Reason::invalid_argument, "a title of " + std::to_string(spec.title.size()) +
                                              " bytes: use at most " +
                                              std::to_string(max_title_bytes))
        .at("title");
  }
  if (spec.loads.empty()) {
    throw Error(Reason::invalid_argument, "the job has no load case: give at least one")
        .at("load_cases");
  }
  if (spec.loads.size() > static_cast<std::size_t>(options.max_load_cases)) {
    throw Error(Reason::limit_exceeded,
                std::to_string(spec.loads.size()) + " load cases: a job may have " +
                    std::to_string(options.max_load_cases) + ", so split it")
        .at("load_cases");
  }
  check_names(spec.loads);
  for (std::size_t i = 0; i < spec.loads.size(); ++i) {
    try {
      fem::check(spec.loads[i], options.max_expression_bytes);
    } catch (Error& error) {
      error.below(path_of(i));
      throw;
    }
  }
  try {
    contact::check(spec.solver, options.max_iterations);
  } catch (Error& error) {
    error.below("solver.uzawa");
    throw;
  }
}

std::string fingerprint(const store::JobSpec& spec) {
  store::CanonicalHash hash;
  hash.add(spec.title).add(spec.mesh).add(std::uint64_t{spec.fields});
  hash.add(std::uint64_t{spec.solver.theta.has_value()}).add(spec.solver.theta.value_or(0));
  hash.add(spec.solver.epsilon).add(spec.solver.p);
  hash.add(static_cast<std::uint64_t>(spec.solver.max_iterations));
  hash.add(static_cast<std::uint64_t>(spec.solver.mass));
  hash.add(std::uint64_t{spec.loads.size()});
  for (const fem::Load& load : spec.loads) {
    hash.add(load.name).add(load.boundary_value).add(std::uint64_t{load.force.index()});
    if (const auto* constant = std::get_if<double>(&load.force)) {
      hash.add(*constant);
    } else if (const auto* expression = std::get_if<fem::Expression>(&load.force)) {
      hash.add(expression->text);
    } else {
      const auto& regions = std::get<fem::PerRegion>(load.force).values;
      hash.add(std::uint64_t{regions.size()});
      for (const auto& [region, value] : regions) {
        hash.add(region).add(value);
      }
    }
  }
  return hash.finish();
}

}  // namespace anticrack::jobs
