// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/case.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string_view>
#include <utility>

#include "casefile/json.hpp"
#include "casefile/sections.hpp"
#include "mesh/geometry.hpp"
#include "toml/long_key.hpp"

namespace anticrack::casefile {
namespace {

bool has_curves(const v1::Geometry& geometry) {
  const auto curved = [](const auto& line) { return line.has_arc() || line.has_spline(); };
  const auto on_curve = [&](const auto& part) { return curved(part.line()); };
  const auto round = [](const auto& of) {
    return of.outline().has_circle() || of.outline().has_spline();
  };
  return std::ranges::any_of(geometry.interfaces(), curved) ||
         std::ranges::any_of(geometry.inclusions(), on_curve) ||
         std::ranges::any_of(geometry.cracks(), on_curve) ||
         std::ranges::any_of(geometry.sides(), on_curve) ||
         std::ranges::any_of(geometry.holes(), round) ||
         std::ranges::any_of(geometry.regions(), round);
}

// The chord angle for which chords change about a tenth of what is asked for: what they change
// falls as the third power of the angle, and is about 1e-4 of the values with the default one.
double chord_angle_for(const v1::Accuracy& accuracy) {
  constexpr double is_for = 1e-3;
  double least = is_for;
  if (accuracy.has_energy()) least = std::min(least, accuracy.energy());
  if (accuracy.has_displacement()) least = std::min(least, accuracy.displacement());
  if (accuracy.has_displacement_estimated())
    least = std::min(least, accuracy.displacement_estimated());
  return mesh::default_chord_angle * std::cbrt(least / is_for);
}

void read_mesh(const Section& root, Case& result) {
  const auto geometry = root.section("geometry");
  const auto mesh = root.section("mesh");
  if (mesh)
    *result.mesh.mutable_options() = read_mesh_options(*mesh, result.spots);
  else
    result.mesh.mutable_options()->set_preset(v1::MESH_PRESET_GRADED);
  if (const auto file = mesh ? mesh->text("file") : std::nullopt) {
    if (geometry) throw Error(geometry->spot(), "there is a mesh.file too; remove one of the two");
    result.mesh_file = *file;
    for (const char* field : {"upload", "header", "chunk"})
      result.spots[field] = mesh->spot_of("file");
    return;
  }
  root.need("geometry", "write [geometry] with boundary and interface, or mesh.file = \"x.msh\"");
  *result.mesh.mutable_geometry() = read_geometry(*geometry, result.spots);
  if (root.find("accuracy") && !(mesh && mesh->find("preset")))
    result.mesh.mutable_options()->set_preset(v1::MESH_PRESET_COARSE);
  if (result.spec.has_accuracy() && !result.mesh.options().has_chord_angle() &&
      has_curves(result.mesh.geometry()))
    result.mesh.mutable_options()->set_chord_angle(chord_angle_for(result.spec.accuracy()));
}

// The text of a line (numbered from 1), shortened.
std::string line_of(const std::string& text, unsigned line) {
  constexpr std::size_t longest = 60;
  std::istringstream lines(text);
  std::string found;
  for (unsigned i = 0; i < line && std::getline(lines, found); ++i) {
  }
  return found.size() > longest ? found.substr(0, longest) + "..." : found;
}

// The cure for a fault behind the = of a key.
std::string cure_of_value(const std::string& description, const std::string& line,
                          unsigned column) {
  const std::size_t equals = line.find('=');
  if (equals == std::string::npos || column < equals + 2 ||
      !description.starts_with("Error while parsing") ||
      description.find("redefine") != std::string::npos)
    return "";
  return "; a value is a number as 3.5, true, false, a text in quotes or a list; units are "
         "named in [units]";
}

toml::table parse(const std::string& text, const std::string& name) {
  if (text.find('\0') != std::string::npos)
    throw Error({"", name, 0}, "this is not text; name a case, a TOML file");
  if (const auto line = toml_text::line_of_long_key(text))
    throw Error({"", name, *line}, toml_text::long_key_message(5));
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    const toml::source_position& place = error.source().begin;
    const std::string line = line_of(text, place.line), problem(error.description());
    throw Error({fmt::format("column {}", place.column), name, place.line},
                "this is not TOML: " + problem + cure_of_value(problem, line, place.column) +
                    "; the line is: " + line);
  }
}

void read_output(const Section& root, Case& result) {
  v1::JobSpec& spec = result.spec;
  bool balanced = false;
  if (const auto output = root.section("output")) {
    if (output->boolean("fields").value_or(false)) spec.add_outputs(v1::OUTPUT_FIELDS);
    read_list(*output, "probe", "probes", *spec.mutable_probes(), result.spots,
              [](const Section& probe, const std::string&, const v1::Probe&) {
                const bool to = probe.find("to") != nullptr;
                if (probe.find("at") ? !to && !probe.find("from") && !probe.find("points")
                                     : to && probe.find("from") && probe.find("points"))
                  return;
                throw Error(probe.spot(),
                            "neither a point nor a line; write at = [x, y] for a point, or from = "
                            "[x, y], to = [x, y] and points = 101 for a line");
              });
    spec.set_without_bounds(!output->boolean("bounds").value_or(true));
    balanced = output->boolean("balanced_flux").value_or(false);
    result.spots["outputs"] = output->spot_of(balanced ? "balanced_flux" : "fields");
    result.spots["probes"] = output->spot_of("probe");
    result.spots["without_bounds"] = output->spot_of("bounds");
  }
  // If there are bounds, fields are drawn with the indicators of their errors.
  if (spec.has_accuracy() || (spec.outputs_size() > 0 && spec.solver().has_active_set() &&
                              !spec.without_bounds() && !spec.has_growth()))
    spec.add_outputs(v1::OUTPUT_INDICATORS);
  if (balanced) spec.add_outputs(v1::OUTPUT_BALANCED_FLUX);
}

}  // namespace

Case parse_case(const std::string& text, const std::string& source,
                const std::vector<std::string>& overrides, Loads loads,
                const std::vector<std::string>& only, Language language) {
  Case result;
  result.text = text;
  const bool json = language == Language::json;
  toml::table table = json ? tables_of_json(text, source) : parse(text, source);
  for (const std::string& assignment : overrides) apply_override(table, assignment);
  if (!only.empty()) keep_loads(table, only);
  if (json || !overrides.empty() || !only.empty()) {
    std::ostringstream out;
    out << table << '\n';
    result.text = out.str();
  }
  const Section root(table, "", case_keys);
  if (root.find("growth") && root.find("accuracy"))
    throw Error(root.spot_of("accuracy"),
                "there is [growth] too, whose mesh stays as it is; remove one of the two");
  fill(root, result.spec, "", result.spots);
  result.mesh.set_title(result.spec.title());
  read_mesh(root, result);
  *result.spec.mutable_solver() = read_solver(root, result.spots);
  if (loads == Loads::needed || root.find("load")) read_loads(root, result);
  read_output(root, result);
  note_missing_tension(result);
  return result;
}

Case mesh_file_case(const std::string& file, const std::vector<std::string>& overrides) {
  Case result;
  toml::table table;
  for (const std::string& assignment : overrides) apply_override(table, assignment);
  const Section root(table, "", msh_keys);
  if (const auto mesh = root.section("mesh")) {
    if (mesh->find("file"))
      throw Error(mesh->spot_of("file"), "the file is given as an argument; remove one of the two");
    *result.mesh.mutable_options() = read_mesh_options(*mesh, result.spots);
  } else {
    result.mesh.mutable_options()->set_preset(v1::MESH_PRESET_GRADED);
  }
  result.mesh_file = file;
  for (const char* field : {"upload", "header", "chunk"}) result.spots[field] = {"", file, 0};
  return result;
}

}  // namespace anticrack::casefile
