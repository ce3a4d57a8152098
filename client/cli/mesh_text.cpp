// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/tables.hpp"

#include <fmt/core.h>

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "cli/progress.hpp"
#include "cli/text.hpp"

namespace anticrack::cli {
namespace {

using Rows = std::vector<std::vector<std::string>>;

std::string kind_of(v1::InterfaceKind kind) {
  constexpr std::array<std::string_view, 6> words{"unknown", "glue",        "crack",
                                                  "bonded",  "delaminated", "free crack"};
  return std::string(word_of(words, kind));
}

template <class Motion>
std::string motion_of(const Motion& motion) {
  if (motion.has_fixed()) return ", u = " + number(motion.fixed());
  return motion.tilt() ? ", tilts" : "";
}

/// The side that comes off, seen along the inclusion, if the case gives it as left or right.
std::string side_of(const v1::Inclusion& inclusion) {
  if (inclusion.has_delaminated() && !inclusion.delaminated()) return "";
  if (inclusion.delaminated_side() == v1::LINE_SIDE_LEFT) return ", its left comes off";
  const bool right = inclusion.delaminated_side() == v1::LINE_SIDE_RIGHT || inclusion.has_line();
  return right ? ", its right comes off" : "";
}

/// For inclusions with other motions than u = A, or with a side that comes off: a text about these,
/// by name, from the definition of the mesh.
std::map<std::string, std::string> motions_of(const v1::Mesh& mesh) {
  std::map<std::string, std::string> motions;
  for (const v1::Inclusion& each : mesh.geometry().inclusions())
    motions[each.name()] += motion_of(each) + side_of(each);
  for (const auto& [name, motion] : mesh.options().inclusion_motions())
    motions[name] += motion_of(motion);
  return motions;
}

std::string head(const v1::Mesh& mesh) {
  std::string text = sanitise(mesh.name()) + ": " + state_text(mesh) + "\n";
  if (!mesh.title().empty()) text += sanitise(mesh.title()) + "\n";
  if (!mesh.owner().empty() || mesh.pinned()) {
    text += mesh.owner().empty() ? "" : "of " + sanitise(mesh.owner());
    text += mesh.owner().empty() || !mesh.pinned() ? "" : ", ";
    text += mesh.pinned() ? "kept in memory until it is evicted\n" : "\n";
  }
  if (mesh.has_error()) text += sanitise(mesh.error().message()) + "\n";
  return text;
}

std::string sizes(const v1::Mesh& mesh) {
  std::string text = fmt::format(
      "{} triangles, {} nodes, meshed in {} s; smallest angle {} degrees", mesh.triangle_count(),
      mesh.node_count(), seconds(mesh.mesh_seconds()), number(mesh.minimum_angle(), 3));
  if (mesh.has_bisection_bound())
    text += " (no grading can go below " + number(mesh.bisection_bound(), 3) + ")";
  text += "\n";
  if (mesh.operator_bytes() > 0) {
    text += "factors of " + bytes(mesh.operator_bytes()) + " made in " +
            seconds(mesh.factorize_seconds()) + " s\n";
  }
  return text;
}

/// A second head, where the case names any: the dimensions as unit_of takes them, empty for none.
void add_units(const v1::Units& units, const std::vector<std::string>& dimensions, Rows& rows) {
  if (units.length().empty() && units.force().empty()) return;
  std::vector<std::string> row;
  for (const std::string& dimension : dimensions)
    row.push_back(dimension.empty() ? "" : results::unit_of(units, dimension));
  rows.push_back(std::move(row));
}

std::string spot(const v1::Point& point) {
  return "(" + number(point.x()) + ", " + number(point.y()) + ")";
}

// An expression, or "along 2, across 1, angle 30".
std::string law_text(const v1::Tension& law) {
  if (law.across().empty()) return law.along();
  return "along " + law.along() + ", across " + law.across() + ", angle " + number(law.angle());
}

std::string subdomains(const v1::Mesh& mesh, const v1::Units& units) {
  Rows rows{{"subdomain", "triangles", "nodes", "area", "tension", "smallest angle",
             "shortest edge", "longest edge", "held by"}};
  add_units(units, {"", "", "", "L^2", "F/L", "degrees", "L", "L", ""}, rows);
  for (const v1::SubdomainInfo& each : mesh.subdomains()) {
    rows.push_back({each.name(), std::to_string(each.triangle_count()),
                    std::to_string(each.node_count()), number(each.area()),
                    each.has_tension_law() ? law_text(each.tension_law()) : number(each.tension()),
                    number(each.minimum_angle(), 3), number(each.shortest_edge(), 3),
                    number(each.longest_edge(), 3),
                    each.floating() ? "interfaces only" : "the boundary"});
  }
  return short_table(std::move(rows), {8});
}

std::string interfaces(const v1::Mesh& mesh, const v1::Units& units) {
  const auto motions = motions_of(mesh);
  const auto inclusion_of = [&](int inclusion) -> std::string {
    if (inclusion < 0 || inclusion >= mesh.inclusions_size()) return "-";
    const std::string& name = mesh.inclusions(inclusion);
    const auto motion = motions.find(name);
    return name + (motion == motions.end() ? "" : motion->second);
  };
  Rows rows{{"interface", "s = 0 at", "s from", "s to", "kind", "inclusion", "edges"}};
  add_units(units, {"", "L", "L", "L", "", "", ""}, rows);
  const std::size_t head = rows.size();
  for (const v1::InterfaceInfo& interface : mesh.interfaces()) {
    for (const auto& segment : interface.segments()) {
      rows.push_back({interface.name(), interface.has_start() ? spot(interface.start()) : "-",
                      number(segment.begin()), number(segment.end()), kind_of(segment.kind()),
                      inclusion_of(segment.inclusion()), std::to_string(segment.edge_count())});
    }
  }
  return rows.size() == head ? "no interfaces\n" : short_table(std::move(rows), {1, 4, 5});
}

std::string tips(const v1::Mesh& mesh, const v1::Units& units) {
  Rows rows{{"tip on", "x", "y", "smallest edge"}};
  add_units(units, {"", "L", "L", "L"}, rows);
  for (const v1::TipInfo& tip : mesh.tips()) {
    rows.push_back({tip.interface(), number(tip.at().x()), number(tip.at().y()),
                    number(tip.smallest_edge(), 3)});
  }
  return mesh.tips_size() == 0 ? "" : "\n" + short_table(std::move(rows));
}

std::string boundary(const v1::Mesh& mesh, const CaseFacts& facts) {
  if (mesh.dirichlet_length() + mesh.neumann_length() <= 0) return "";  // the server does not tell
  std::string sides;
  for (const std::string& name : mesh.geometry().neumann_sides())
    sides += (sides.empty() ? ": " : ", ") + sanitise(name);
  const std::string shown = sanitise(results::unit_behind(facts.units, "L"));
  std::string text =
      "\nboundary: u given on a length of " + number(mesh.dirichlet_length()) + shown;
  if (mesh.neumann_length() > 0)
    text += (facts.free ? ", free on " : ", free or traction on ") + number(mesh.neumann_length()) +
            shown + sides;
  return text + "\n";
}

}  // namespace

std::string mesh_text(const v1::Mesh& mesh, const CaseFacts& facts) {
  std::string text = head(mesh);
  if (mesh.triangle_count() > 0) {
    text += sizes(mesh) + "\n" + subdomains(mesh, facts.units) + "\n" +
            interfaces(mesh, facts.units) + tips(mesh, facts.units) + boundary(mesh, facts);
  }
  for (const std::string& warning : mesh.warnings()) text += "warning: " + sanitise(warning) + "\n";
  return text;
}

}  // namespace anticrack::cli
