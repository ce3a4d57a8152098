// SPDX-License-Identifier: GPL-3.0-or-later
//
// One function per section of a case, and what they share. For the sources of this folder only.
// Each reads its section into a message and records in `spots` where every field was written.
#pragma once

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

inline const std::vector<std::string> geometry_keys{"boundary", "hole",    "interface", "inclusion",
                                                    "crack",    "neumann", "region"};
inline const std::vector<std::string> mesh_keys{"preset",      "size",      "tip_size", "grading",
                                                "chord_angle", "align",     "file",     "groups",
                                                "tension",     "inclusions"};

/// `section` is [geometry], read with geometry_keys.
v1::Geometry read_geometry(const Section& section, Spots& spots);

/// Notes regions that give no tension where others do, or that none does though there are units.
/// Once the case is read.
void note_missing_tension(Case& result);

/// `interface` of [geometry]: a list of points, or tables with points, arc or spline. Optional.
void read_interfaces(const Section& section, v1::Geometry& geometry, Spots& spots);

/// `neumann` of [geometry], once boundary and holes are read.
void read_neumann(const Section& section, v1::Geometry& geometry, Spots& spots);

/// Inclusions and cracks of [geometry].
void read_parts(const Section& section, v1::Geometry& geometry, Spots& spots);

/// Keys of lines with two ends, in the order of `shape_of`.
inline const std::vector<std::string> line_keys{"points", "arc", "spline", "center"};

/// The one key among `keys` that gives the shape of `what`; empty for none. Throws Error for two.
std::string shape_of(const Section& section, const std::vector<std::string>& keys,
                     const std::string& what);

/// Points, arc or spline, by their key.
void read_curve(const Section& section, const std::string& key, const std::string& field,
                v1::InterfaceCurve& curve, Spots& spots);

/// A line by a key of line_keys.
void read_line(const Section& section, const std::string& key, const std::string& field,
               v1::Line& line, Spots& spots);

/// circle, points or spline, one of them. Throws Error where there is none.
void read_outline(const Section& section, const std::string& what, const std::string& field,
                  v1::Outline& outline, Spots& spots);

/// Whether a key holds a table or a list of tables.
bool lists_tables(const toml::node& node);

/// `section` is [mesh], read with mesh_keys. Throws Error for a key that has no meaning beside the
/// others: sizes of another preset, `align` with a file, groups, tension and inclusions without
/// one.
v1::MeshOptions read_mesh_options(const Section& section, Spots& spots);

/// A number, or a law: an expression in quotes, or {along, across, angle}. None: no such key.
using GivenTension = std::variant<double, v1::Tension>;
std::optional<GivenTension> tension_of(const Section& section, const std::string& key);
/// Those by subdomain of a mesh from a file.
void read_tensions(const Section& section, v1::MeshOptions& options, Spots& spots);

/// [solver] of the root. Throws Error for a key of the other method.
v1::Solver read_solver(const Section& root, Spots& spots);

/// Every [[load]] of the root: fills in the job's load cases, force_files and spots.
void read_loads(const Section& root, Case& result);

/// [job] of the root: priority and time limits.
void read_job(const Section& root, v1::Job& job, Spots& spots);

/// [units] of the root.
void read_units(const Section& root, v1::Job& job, Spots& spots);

/// [accuracy] of the root, once solver and loads are read: Error where they do not go with it.
void read_accuracy(const Section& root, Case& result);

/// Seconds as a number, or text with a unit; empty where the key is absent.
std::optional<google::protobuf::Duration> read_time(const Section& section, const char* key);

/// Writes the value of "key=value" into the case. The key is a dotted path. An entry of an array is
/// an index from 0 (one past the end appends a table) or, where all entries have one, a `name`.
/// Missing tables are created. The value is TOML; anything else is text, so quotes may be omitted.
/// Throws Error for a key that does not exist, control characters and invalid UTF-8.
void apply_override(toml::table& root, const std::string& assignment);

/// Removes every [[load]] but those of these names. Throws Error for a name that none has.
void keep_loads(toml::table& root, const std::vector<std::string>& names);

/// Records where the section and its values were written, as FIELD and FIELD.KEY.
void note(const Section& section, const std::string& field, Spots& spots);

/// Writes both coordinates.
inline void set(v1::Point& point, const Point& xy) {
  point.set_x(xy[0]);
  point.set_y(xy[1]);
}

/// [from, to], points of an interface or of the boundary, into a message with both.
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

/// "list[3]": the field of an entry of a repeated field.
inline std::string entry_field(const std::string& list, std::integral auto index) {
  return list + "[" + std::to_string(index) + "]";
}

/// Throws Error with the reason for a key that has no meaning here.
inline void refuse_keys(const Section& section, const std::vector<const char*>& keys,
                        const char* why) {
  for (const char* key : keys)
    if (section.find(key)) throw Error(section.spot_of(key), why);
}

/// Reads tilt and fixed of an inclusion.
template <class Motion>
void read_motion(const Section& section, Motion& motion) {
  motion.set_tilt(section.boolean("tilt").value_or(false));
  const auto fixed = section.number("fixed");
  if (!fixed) return;
  if (motion.tilt()) {
    throw Error(section.spot_of("fixed"),
                "the inclusion has tilt = true too, but one that is held does not tilt; remove one "
                "of the two");
  }
  motion.set_fixed(*fixed);
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
