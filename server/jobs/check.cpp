// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/check.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <unordered_set>
#include <variant>

#include "errors/errors.hpp"
#include "jobs/sweep_check.hpp"
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

std::string load_path(std::size_t load) {
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
          .at(load_path(i) + ".name");
    }
    if (!names.insert(name).second) {
      throw Error(Reason::invalid_argument,
                  "two load cases are named \"" + name + "\": give each its own name")
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
    throw Error(Reason::limit_exceeded, std::to_string(loads) + " load cases: a job may have " +
                                            std::to_string(options.max_load_cases) +
                                            ", so split it")
        .at("load_cases");
  }
}

struct HashForce {
  store::CanonicalHash& hash;

  void operator()(double constant) const { hash.add(constant); }
  void operator()(const fem::Expression& expression) const { hash.add(expression.text); }
  void operator()(const fem::PerRegion& regions) const { add_named(hash, regions.values); }
  void operator()(const fem::Array& array) const {
    hash.add(array.upload).add(std::uint64_t{array.per_triangle});
  }

  static void add_named(store::CanonicalHash& hash, const std::map<std::string, double>& values) {
    hash.add(std::uint64_t{values.size()});
    for (const auto& [name, value] : values) {
      hash.add(name).add(value);
    }
  }
};

void add_optional(store::CanonicalHash& hash, const std::optional<double>& value) {
  hash.add(std::uint64_t{value.has_value()}).add(value.value_or(0));
}

struct HashSolver {
  store::CanonicalHash& hash;

  void operator()(const contact::UzawaOptions& options) const {
    add_optional(hash, options.theta);
    hash.add(options.epsilon).add(options.p);
    hash.add(static_cast<std::uint64_t>(options.max_iterations));
    hash.add(static_cast<std::uint64_t>(options.mass));
    add_optional(hash, options.kkt_tolerance);
  }
  void operator()(const contact::ActiveSetOptions& options) const {
    hash.add(options.tolerance).add(static_cast<std::uint64_t>(options.max_steps));
  }
};

void add_load(store::CanonicalHash& hash, const fem::Load& load) {
  hash.add(load.name).add(load.boundary_value).add(load.traction);
  hash.add(std::uint64_t{load.force.index()});
  std::visit(HashForce{hash}, load.force);
  hash.add(std::uint64_t{load.point_forces.size()});
  for (const fem::PointForce& force : load.point_forces) {
    hash.add(force.x).add(force.y).add(force.value);
  }
  HashForce::add_named(hash, load.inclusion_forces);
}

void check_time(std::chrono::milliseconds wanted, std::chrono::milliseconds longest,
                const char* field) {
  if (wanted.count() < 0) {
    throw Error(Reason::invalid_argument, std::to_string(wanted.count()) +
                                              " ms is no time limit: give a positive one, or none")
        .at(field);
  }
  if (wanted > longest) {
    throw Error(Reason::limit_exceeded, std::to_string(wanted.count()) +
                                            " ms is longer than this server allows, " +
                                            std::to_string(longest.count()) + " ms")
        .at(field);
  }
}

struct BytesOfForce {
  std::uint64_t operator()(double /*constant*/) const { return 0; }
  std::uint64_t operator()(const fem::Expression& expression) const {
    return expression.text.size();
  }
  std::uint64_t operator()(const fem::PerRegion& regions) const { return named(regions.values); }
  std::uint64_t operator()(const fem::Array& array) const { return array.upload.size(); }

  static std::uint64_t named(const std::map<std::string, double>& values) {
    constexpr std::uint64_t node = 96;
    std::uint64_t bytes = node * values.size();
    for (const auto& [name, value] : values) {
      bytes += name.size();
    }
    return bytes;
  }
};

}  // namespace

std::uint64_t bytes_of(const store::JobSpec& spec) {
  std::uint64_t bytes = sizeof(spec) + spec.title.size() + spec.mesh.size();
  for (const fem::Load& load : spec.loads) {
    bytes += sizeof(load) + load.name.size() + load.boundary_value.size() + load.traction.size() +
             std::visit(BytesOfForce{}, load.force) +
             load.point_forces.size() * sizeof(fem::PointForce) +
             BytesOfForce::named(load.inclusion_forces);
  }
  if (spec.sweep) {
    bytes += spec.sweep->upload.size() + spec.sweep->traces.size() * sizeof(std::uint32_t);
  }
  return bytes;
}

void check(const store::JobSpec& spec, const EngineOptions& options) {
  if (spec.title.size() > max_title_bytes) {
    throw Error(Reason::invalid_argument, "a title of " + std::to_string(spec.title.size()) +
                                              " bytes: use at most " +
                                              std::to_string(max_title_bytes))
        .at("title");
  }
  if (spec.sweep) {
    check_sweep(spec, options);
  } else {
    check_count(spec.loads.size(), options);
  }
  check_names(spec.loads);
  for (std::size_t i = 0; i < spec.loads.size(); ++i) {
    try {
      fem::check(spec.loads[i], options.max_expression_bytes);
    } catch (Error& error) {
      error.below(load_path(i));
      throw;
    }
  }
  try {
    contact::check(spec.solver, options.max_iterations);
  } catch (Error& error) {
    error.below("solver");
    throw;
  }
  check_time(spec.queue_time_limit, options.queue_time, "queue_timeout");
  check_time(spec.run_time_limit, options.run_time, "run_timeout");
}

std::string fingerprint(const store::JobSpec& spec) {
  store::CanonicalHash hash;
  hash.add(spec.title).add(spec.mesh).add(std::uint64_t{spec.fields});
  hash.add(static_cast<std::uint64_t>(spec.priority));
  hash.add(static_cast<std::uint64_t>(spec.queue_time_limit.count()));
  hash.add(static_cast<std::uint64_t>(spec.run_time_limit.count()));
  hash.add(std::uint64_t{spec.solver.index()});
  std::visit(HashSolver{hash}, spec.solver);
  hash.add(std::uint64_t{spec.loads.size()});
  for (const fem::Load& load : spec.loads) {
    add_load(hash, load);
  }
  if (spec.sweep) {  // not its rows: they follow from the upload and the mesh
    hash.add(static_cast<std::uint64_t>(spec.sweep->cases)).add(spec.sweep->upload);
    hash.add(std::uint64_t{spec.sweep->traces.size()});
    for (const std::uint32_t row : spec.sweep->traces) {
      hash.add(std::uint64_t{row});
    }
  }
  return hash.finish();
}

}  // namespace anticrack::jobs
