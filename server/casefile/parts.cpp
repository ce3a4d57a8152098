// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/sections.hpp"

namespace anticrack::casefile {
namespace {

std::vector<std::string> keys(std::vector<std::string> own) {
  for (const char* key :
       {"name", "from", "to", "points", "arc", "spline", "center", "angle", "length"})
    own.emplace_back(key);
  return own;
}

// Where an inclusion or crack lies: from and to on an interface, or a line of its own.
template <class Owner>
void read_place(const Section& section, const std::string& what, const std::string& field,
                Owner& owner, Spots& spots) {
  note(section, field, spots);
  const std::string shape = shape_of(section, line_keys, what);
  if (shape != "center") {
    refuse_keys(section, {"angle", "length"},
                "belongs to center; write center = [x, y], angle in degrees and length");
  }
  if (!shape.empty()) {
    const std::string why = "belongs to a part of an interface, but " + what + " has " + shape +
                            ", a line of its own; remove one of the two";
    refuse_keys(section, {"from", "to"}, why.c_str());
    return read_line(section, shape, field + ".line", *owner.mutable_line(), spots);
  }
  constexpr const char* cure =
      "write [x, y], a point of an interface, or a line of its own: points, arc, spline, or "
      "center, "
      "angle and length";
  for (const char* key : {"from", "to"}) {
    const toml::node& node = section.need(key, cure);
    set(key == std::string("from") ? *owner.mutable_part()->mutable_from()
                                   : *owner.mutable_part()->mutable_to(),
        point_of(node, section.path_of(key)));
    spots[field + ".part." + key] = section.spot_of(key);
  }
  spots[field + ".part"] = section.spot_of("from");
}

std::optional<v1::LineSide> side_named(const std::string& name) {
  if (name == "left") return v1::LINE_SIDE_LEFT;
  if (name == "right") return v1::LINE_SIDE_RIGHT;
  return std::nullopt;
}

// Pairs of points, or of numbers: stretches by arc length.
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
  spots[field + ".delaminated_side"] = section.spot_of("side");
  if (const auto side = section.choice("side", {"left", "right"}))
    inclusion.set_delaminated_side(*side == 0 ? v1::LINE_SIDE_LEFT : v1::LINE_SIDE_RIGHT);
  const toml::node* node = section.find("delaminated");
  if (!node) return;
  const std::string key = section.path_of("delaminated");
  const std::string parts = field + ".delaminated_parts";
  spots[parts] = section.spot_of("delaminated");
  const auto side = side_named(node->value_exact<std::string>().value_or(""));
  if (side && section.find("side"))
    throw Error(section.spot_of("side"), "delaminated names a side too; remove one of the two");
  if (const toml::array* list = node->as_array()) {
    read_delaminated_parts(*list, key, parts, *inclusion.mutable_delaminated_parts(), spots);
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
  for (const Section& section : geometry_section.sections(
           "inclusion", keys({"delaminated", "side", "tilt", "fixed", "contact"}))) {
    refuse_keys(section, {"contact"},
                "belongs to [[geometry.crack]]; an inclusion has delaminated = true or false");
    const std::string field = entry_field("geometry.inclusions", geometry.inclusions().size());
    v1::Inclusion& inclusion = *geometry.add_inclusions();
    inclusion.set_name(section.need_text("name", "give the inclusion a name"));
    read_place(section, "the inclusion", field, inclusion, spots);
    read_delamination(section, field, inclusion, spots);
    read_motion(section, inclusion);
  }
  for (const Section& section :
       geometry_section.sections("crack", keys({"contact", "side", "tilt", "fixed"}))) {
    refuse_keys(section, {"tilt", "fixed"},
                "belongs to [[geometry.inclusion]]; nothing rigid lies on a crack, so remove it");
    refuse_keys(section, {"side"},
                "belongs to [[geometry.inclusion]]; the plus side of a crack is on its left, so "
                "write it the other way round");
    const std::string field = entry_field("geometry.cracks", geometry.cracks().size());
    v1::Crack& crack = *geometry.add_cracks();
    crack.set_name(section.need_text("name", "give the crack a name"));
    read_place(section, "the crack", field, crack, spots);
    if (const auto contact = section.boolean("contact")) crack.set_contact(*contact);
  }
}

}  // namespace anticrack::casefile
