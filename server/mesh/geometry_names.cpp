// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry_steps.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>

#include "mesh/geometry_outline.hpp"
#include "mesh/geometry_primitives.hpp"
#include "mesh/names.hpp"

namespace anticrack::mesh {
namespace {

class Names {
 public:
  void add(const std::string& name, const std::string& owner, const char* all) {
    const std::string field = owner + ".name";
    if (!valid_name(name)) {
      // the quoted text goes into messages and logs
      const bool printable =
          std::all_of(name.begin(), name.end(), [](char c) { return c >= ' ' && c <= '~'; });
      refuse(field, field, " is ",
             name.empty()       ? "empty"
             : !printable       ? "not printable"
             : name.size() > 64 ? fmt::format("of {} characters", name.size())
                                : "\"" + name + "\"",
             "; a name is ", name_rule);
    }
    const auto [entry, added] = _used.emplace(name, owner);
    if (added) return;
    refuse(field, field, " \"", name, "\" is already the name of ", entry->second, "; every ", all,
           " needs its own");
  }

 private:
  std::map<std::string, std::string> _used;
};

}  // namespace

std::vector<std::string> side_names(const Geometry& geometry) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name, const char* other, std::size_t i) {
    names.push_back(name.empty() ? fmt::format("{}{}", other, i + 1) : name);
  };
  for (std::size_t i = 0; i < geometry.boundary.size(); ++i) add("", "side-", i);
  for (std::size_t i = 0; i < geometry.sides.size(); ++i) add(geometry.sides[i].name, "side-", i);
  for (std::size_t i = 0; i < geometry.holes.size(); ++i) add(geometry.holes[i].name, "hole-", i);
  return names;
}

std::vector<std::string> check_names(const Drawn& geometry) {
  check_count(geometry.inclusions.size(), "inclusions");
  check_count(geometry.cracks.size(), "cracks");
  check_count(geometry.regions.size(), "regions");
  check_count(geometry.neumann.size(), "neumann");
  Names parts;
  for (std::size_t i = 0; i < geometry.inclusions.size(); ++i)
    parts.add(geometry.inclusions[i].name, indexed("inclusions", i), "inclusion and crack");
  for (std::size_t i = 0; i < geometry.cracks.size(); ++i)
    parts.add(geometry.cracks[i].name, indexed("cracks", i), "inclusion and crack");
  Names regions;
  for (std::size_t i = 0; i < geometry.regions.size(); ++i)
    regions.add(geometry.regions[i].name, indexed("regions", i), "region");
  Names sides;
  const std::vector<std::string> boundary = side_names(geometry);
  const std::size_t outer = boundary.size() - geometry.holes.size();
  for (std::size_t i = 0; i < boundary.size(); ++i) {
    sides.add(boundary[i], i < outer ? indexed("sides", i) : indexed("holes", i - outer),
              "side and hole");
  }
  // a line of an inclusion, crack or region has the owner's name, which has been checked
  Names lines;
  std::vector<std::string> interfaces;
  interfaces.reserve(geometry.interfaces.size());
  for (std::size_t i = 0; i < geometry.interfaces.size(); ++i) {
    const std::string& field = geometry.fields[i].path;
    std::string name = geometry.interfaces[i].name;
    if (name.empty()) name = i == 0 ? "interface" : fmt::format("interface-{}", i + 1);
    lines.add(name, field.substr(0, field.find('.')), "interface");
    interfaces.push_back(std::move(name));
  }
  return interfaces;
}

std::string unused_name(const std::string& name, std::vector<std::string>& used) {
  std::string candidate = name;
  for (int k = 2; std::find(used.begin(), used.end(), candidate) != used.end(); ++k)
    candidate = fmt::format("{}-{}", name, k);
  used.push_back(candidate);
  return candidate;
}

}  // namespace anticrack::mesh
