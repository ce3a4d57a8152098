// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/sections.hpp"

namespace anticrack::casefile {
namespace {

// Throws Error for a key that has no meaning here.
void refuse_keys(const Section& section, const std::vector<const char*>& keys,
                 const std::string& why) {
  for (const char* key : keys)
    if (section.find(key)) throw Error(section.spot_of(key), why);
}

// Reads the place of an inclusion or crack: from and to on an interface, or a line of its own.
template <class Owner>
void read_place(const Section& section, const std::string& what, const std::string& field,
                Owner& owner, Spots& spots) {
  const std::string shape = shape_of(section, what);
  if (shape != "center") {
    refuse_keys(section, {"angle", "length"},
                "belongs to center; write center = [x, y], angle in degrees and length");
  }
  if (!shape.empty()) {
    refuse_keys(section, {"from", "to"},
                "belongs to a part of an interface, but " + what + " has " + shape +
                    ", a line of its own; remove one of the two");
    return read_line(section, shape, field + ".line", *owner.mutable_line(), spots);
  }
  for (const char* key : {"from", "to"}) {
    section.need(key,
                 "write [x, y], a point of an interface, or a line of its own: points, arc, "
                 "spline, or center, angle and length");
  }
  spots[field + ".part"] = section.spot_of("from");
}

std::optional<v1::LineSide> side_named(const std::string& name) {
  if (name == "left") return v1::LINE_SIDE_LEFT;
  if (name == "right") return v1::LINE_SIDE_RIGHT;
  return std::nullopt;
}

// Reads pairs of points, or pairs of numbers, which are stretches by arc length.
void read_delaminated_parts(const toml::array& list, const std::string& key,
                            const std::string& field, v1::InterfaceParts& parts, Spots& spots) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    const toml::node& entry = *list.get(i);
    const std::string path = entry_key(key, i);
    const toml::array* pair = entry.as_array();
    if (pair && !pair->empty() && pair->get(0)->is_number()) {
      const Point stretch = pair_of(entry, path, "a stretch",
                                    "write [0.5, 1.0], by arc length over the whole length");
      spots[entry_field(field + ".stretches", parts.stretches_size())] = spot_of(entry, path);
      v1::Stretch& added = *parts.add_stretches();
      added.set_from(stretch[0]);
      added.set_to(stretch[1]);
    } else {
      spots[entry_field(field + ".parts", parts.parts_size())] = spot_of(entry, path);
      read_pair(entry, path, *parts.add_parts());
    }
  }
}

void read_delamination(const Section& section, const std::string& field, v1::Inclusion& inclusion,
                       Spots& spots) {
  const toml::node* node = section.find("delaminated");
  if (!node) return;
  const std::string key = section.path_of("delaminated");
  const auto side = side_named(node->value_exact<std::string>().value_or(""));
  if (side && section.find("side"))
    throw Error(section.spot_of("side"), "delaminated names a side too; remove one of the two");
  if (const toml::array* list = node->as_array()) {
    read_delaminated_parts(*list, key, field + ".delaminated_parts",
                           *inclusion.mutable_delaminated_parts(), spots);
  } else if (const auto all = node->value_exact<bool>()) {
    if (!*all && section.find("side"))
      throw Error(section.spot_of("side"),
                  "nothing comes off on it, as delaminated = false; remove one of the two");
    inclusion.set_delaminated(*all);
  } else if (side) {
    inclusion.set_delaminated(true);
    inclusion.set_delaminated_side(*side);
  } else {
    throw Error(spot_of(*node, key),
                shown(*node) +
                    " is not possible; write true, false, \"left\", \"right\", [[from, to], ...] "
                    "or [[0.5, 1.0], ...], stretches of its length");
  }
}

}  // namespace

void read_parts(const Section& geometry_section, v1::Geometry& geometry, Spots& spots) {
  read_list(geometry_section, "inclusion", "geometry.inclusions", *geometry.mutable_inclusions(),
            spots, [&](const Section& section, const std::string& field, v1::Inclusion& inclusion) {
              read_place(section, "the inclusion", field, inclusion, spots);
              read_delamination(section, field, inclusion, spots);
            });
  read_list(geometry_section, "crack", "geometry.cracks", *geometry.mutable_cracks(), spots,
            [&](const Section& section, const std::string& field, v1::Crack& crack) {
              read_place(section, "the crack", field, crack, spots);
            });
}

}  // namespace anticrack::casefile
