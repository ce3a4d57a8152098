// SPDX-License-Identifier: GPL-3.0-or-later
//
// One function per section of a case, and functions that these share. For this folder only. Each
// function reads its section into a message and records in `spots` where every field was written.
#pragma once

#include <fmt/core.h>

#include <concepts>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "casefile/case.hpp"
#include "casefile/error.hpp"
#include "casefile/section.hpp"

namespace anticrack::casefile {

/// Field of a request -> where its value was written.
using Spots = std::map<std::string, Spot>;

/// Reads the values of plain types of a section, and of plain tables below it, into its message by
/// its table of keys, and notes where they were written. Throws Error for a wrong type and for a
/// key that is needed and missing.
void fill(const Section& section, google::protobuf::Message& message, const std::string& field,
          Spots& spots);

/// `section` is [geometry].
v1::Geometry read_geometry(const Section& section, Spots& spots);

/// Adds a note if some regions give no tension while others do, or if none does though there are
/// units. To be called when the case has been read.
void note_missing_tension(Case& result);

/// `interface` of [geometry]: a list of points, or tables with points, arc or spline. Optional.
void read_interfaces(const Section& section, v1::Geometry& geometry, Spots& spots);

/// Reads `neumann` of [geometry], after boundary and holes.
void read_neumann(const Section& section, v1::Geometry& geometry, Spots& spots);

/// Reads inclusions and cracks of [geometry].
void read_parts(const Section& section, v1::Geometry& geometry, Spots& spots);

/// The key among points, arc, spline, circle, center and at that gives the shape of `what`; empty
/// for none. Throws Error for two.
std::string shape_of(const Section& section, const std::string& what);

/// Reads points, arc or spline, by their key.
void read_curve(const Section& section, const std::string& key, const std::string& field,
                v1::InterfaceCurve& curve, Spots& spots);

/// Reads the same, or checks that a center, which `fill` has read, has its length.
void read_line(const Section& section, const std::string& key, const std::string& field,
               v1::Line& line, Spots& spots);

/// Reads one of circle, points and spline, besides what `fill` reads. Throws Error if there is
/// none.
void read_outline(const Section& section, const std::string& what, const std::string& field,
                  v1::Outline& outline, Spots& spots);

/// Whether a key holds a table or a list of tables.
bool lists_tables(const toml::node& node);

/// `section` is [mesh].
v1::MeshOptions read_mesh_options(const Section& section, Spots& spots);

/// A number, or a law: an expression in quotes, or {along, across, angle}.
using GivenTension = std::variant<double, v1::Tension>;
GivenTension tension_of(const toml::node& node, const std::string& path, const Keys& law);
/// Reads the tensions by subdomain of a mesh from a file.
void read_tensions(const Section& section, v1::MeshOptions& options, Spots& spots);

/// Reads [solver] of the root. Throws Error for a key of the other method.
v1::Solver read_solver(const Section& root, Spots& spots);

/// Reads every [[load]] of the root: fills in the job's load cases, force_files and spots.
void read_loads(const Section& root, Case& result);

/// Writes the value of "key=value" into the case. The key is a dotted path. An entry of an array is
/// an index from 0 (one past the end appends a table) or, where all entries have one, a `name`.
/// Missing tables are created. The value is TOML; anything else is text, so quotes may be omitted.
/// Throws Error for a key that does not exist, control characters and invalid UTF-8.
void apply_override(toml::table& root, const std::string& assignment);

/// Removes every [[load]] except those with these names. Throws Error for a name that no load has.
void keep_loads(toml::table& root, const std::vector<std::string>& names);

/// Records where the section and its values were written, as FIELD and FIELD.PATH, with the path of
/// each key's row.
void note(const Section& section, const std::string& field, Spots& spots);

/// Sets both coordinates.
inline void set(v1::Point& point, const Point& xy) {
  point.set_x(xy[0]);
  point.set_y(xy[1]);
}

/// Reads [from, to], points of an interface or of the boundary, into a message with both.
template <class Part>
void read_pair(const toml::node& node, const std::string& key, Part& part) {
  const toml::array* pair = node.as_array();
  if (!pair || pair->size() != 2) {
    throw Error(
        spot_of(node, key),
        shown(node) + " is not a part; a part is [from, to], and a list of parts [[from, to]]");
  }
  set(*part.mutable_from(), point_of(*pair->get(0), entry_key(key, 0)));
  set(*part.mutable_to(), point_of(*pair->get(1), entry_key(key, 1)));
}

/// The field of an entry of a repeated field: "list[3]".
inline std::string entry_field(const std::string& list, std::integral auto index) {
  return fmt::format("{}[{}]", list, index);
}

/// Adds a message for each table of [[key]]: fills it, and lets `read` do the rest, which is called
/// with the section, its field and its message.
template <class List, class Read>
void read_list(const Section& section, const char* key, const std::string& field, List& list,
               Spots& spots, const Read& read) {
  for (const Section& entry : section.sections(key)) {
    const std::string path = entry_field(field, list.size());
    auto& message = *list.Add();
    fill(entry, message, path, spots);
    read(entry, path, message);
  }
}

/// Records the spot of an entry of a map, in both notations of a field violation.
inline void set_entry(Spots& spots, const std::string& map, const std::string& key,
                      const Spot& spot) {
  spots[map + "[" + key + "]"] = spot;
  spots[map + "." + key] = spot;
}

/// Adds the points of a node [[x, y], ...] to a repeated field, and their spots.
template <class Points>
void add_points(const toml::node& node, const std::string& key, const std::string& field,
                Points& points, Spots& spots) {
  const std::vector<Point> list = points_of(node, key);
  for (std::size_t i = 0; i < list.size(); ++i) {
    set(*points.Add(), list[i]);
    spots[entry_field(field, i)] = spot_of(*node.as_array()->get(i), entry_key(key, i));
  }
}

/// Copies {name = number, ...} of a key into a map, and records the spots of its entries.
template <class Map>
void add_numbers(const Section& section, const std::string& key, const char* cure,
                 const std::string& field, Map& map, Spots& spots) {
  for (const auto& [name, value] : section.numbers(key, cure)) {
    map[name] = value;
    const toml::node& entry = *section.find(key)->as_table()->get(name);
    set_entry(spots, field, name, spot_of(entry, section.path_of(key) + "." + name));
  }
}

}  // namespace anticrack::casefile
