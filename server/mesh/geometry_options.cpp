// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry.hpp"

#include <fmt/core.h>

#include <cmath>

#include "mesh/geometry_primitives.hpp"
#include "mesh/names.hpp"

namespace anticrack::mesh {
namespace {

[[noreturn]] void refuse_option(const std::string& field, const std::string& message) {
  throw errors::Error(errors::Reason::invalid_argument, message).at(field);
}

void check_length(double value, const std::string& field, const char* meaning) {
  if (std::isfinite(value) && value >= 0) return;
  refuse_option(field, field + " is " + shown(value) + "; it is " + meaning +
                           " above 0; leave it unset for the default");
}

void check_sizes(const MeshOptions& options) {
  check_length(options.size, "options.size", "an edge length");
  check_length(options.tip_size, "options.tip_size", "an edge length");
  if (!(options.chord_angle >= 0 && options.chord_angle <= 45)) {
    refuse_option("options.chord_angle",
                  "options.chord_angle is " + shown(options.chord_angle) +
                      "; it is a number of degrees above 0 and at most 45, five if unset");
  }
  if (!(options.grading > 0 && options.grading <= 1)) {
    refuse_option("options.grading", "options.grading is " + shown(options.grading) +
                                         "; it is an exponent above 0 and at most 1");
  }
  const auto of_graded = [&](double value, double unset, const std::string& field) {
    if (value != unset && !graded(options.preset))
      refuse_option(field, "means nothing without preset graded; leave it out, or choose that");
  };
  of_graded(options.tip_size, 0, "options.tip_size");
  of_graded(options.grading, MeshOptions().grading, "options.grading");
  if (options.size > 0 && options.tip_size > options.size) {
    refuse_option("options.tip_size", "options.tip_size is " + shown(options.tip_size) +
                                          ", above options.size " + shown(options.size));
  }
}

/// The quoted text goes into messages and logs.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text.substr(0, 80)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + "\"";
}

void check_curve_group(const std::string& name, const std::string& field) {
  for (const char* whole : {"dirichlet", "neumann", "crack", "free", "glue"})
    if (name == whole) return;
  for (const std::string prefix :
       {"dirichlet:", "neumann:", "crack:", "free:", "inclusion:", "delaminated:"})
    if (name.starts_with(prefix) && valid_name(name.substr(prefix.size()))) return;
  refuse_option(field, field + " is " + quoted(name) +
                           "; a curve is dirichlet, dirichlet:NAME, neumann, neumann:NAME, glue, "
                           "crack, crack:NAME, free, free:NAME, inclusion:NAME or "
                           "delaminated:NAME, NAME being " +
                           std::string(name_rule));
}

void check_subdomain(const std::string& name, const std::string& field) {
  if (valid_name(name)) return;
  refuse_option(field, field + " names " + quoted(name) + "; a name is " + std::string(name_rule));
}

}  // namespace

void check_for_geometry(const MeshOptions& options) {
  check_sizes(options);
  if (options.preset == Preset::paper && options.size > 0) {
    refuse_option("options.size",
                  "means nothing with preset paper, which fixes the intervals; leave it out, or "
                  "choose preset graded");
  }
  if (options.preset == Preset::paper && !options.align.empty())
    refuse_option("options.align",
                  "preset paper has no lines to follow; leave them out, or choose "
                  "preset graded");
  const auto for_uploads = [](bool empty, const char* field, const char* cure) {
    if (empty) return;
    refuse_option(field, std::string("belongs to a mesh from a file; ") + cure);
  };
  for_uploads(options.curve_groups.empty(), "options.curve_groups",
              "say in the geometry where inclusions and cracks lie");
  for_uploads(options.surface_groups.empty(), "options.surface_groups",
              "name subdomains by the regions of the geometry");
  for_uploads(options.tension.empty(), "options.tension",
              "give tensions in the regions of the geometry");
  for_uploads(options.tension_laws.empty(), "options.tension_laws",
              "give tensions in the regions of the geometry");
  for_uploads(options.inclusion_motions.empty(), "options.inclusion_motions",
              "say tilt or fixed in the inclusions of the geometry");
}

void check_for_upload(const MeshOptions& options) {
  check_sizes(options);
  if (options.preset == Preset::paper) {
    refuse_option("options.preset",
                  "preset paper is for a geometry; an upload is taken as it is (uniform) or "
                  "graded");
  }
  const auto for_geometries = [](bool empty, const std::string& field) {
    if (!empty)
      refuse_option(field,
                    "means nothing for a mesh from a file, which has its edges; leave it out");
  };
  for_geometries(options.align.empty(), "options.align");
  for_geometries(options.chord_angle == 0, "options.chord_angle");
  for (const auto& [tag, name] : options.curve_groups)
    check_curve_group(name, fmt::format("options.curve_groups[{}]", tag));
  for (const auto& [tag, name] : options.surface_groups)
    check_subdomain(name, fmt::format("options.surface_groups[{}]", tag));
  for (const auto& [name, tension] : options.tension) {
    // The import, which numbers unnamed subdomains, checks whether such a subdomain exists.
    if (std::isfinite(tension) && tension > 0) continue;
    const std::string field = "options.tension[" + name + "]";
    refuse_option(field, field + " is " + shown(tension) + "; a tension is a number above 0");
  }
  for (const auto& [name, law] : options.tension_laws) {
    const std::string field = "options.tension_laws[" + name + "]";
    const std::string fault = fault_of(law);
    if (!fault.empty()) refuse_option(field, field + ": " + fault);
    if (options.tension.contains(name))
      refuse_option(field, field + " and options.tension[" + name + "] are given; leave one out");
  }
  for (const auto& [name, motion] : options.inclusion_motions) {
    // The import checks whether such an inclusion exists.
    const std::string field = "options.inclusion_motions[" + name + "]";
    const std::string fault = fault_of(motion);
    if (!fault.empty()) refuse_option(field, field + ": " + fault);
  }
}

}  // namespace anticrack::mesh
