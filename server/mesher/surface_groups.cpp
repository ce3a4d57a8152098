// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/surface_groups.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "errors/errors.hpp"
#include "mesh/names.hpp"
#include "mesh/union_find.hpp"
#include "mesher/curve_groups.hpp"
#include "mesher/msh_scanner.hpp"
#include "mesher/refuse.hpp"

namespace anticrack::mesher {
namespace {

using mesh::Mesh;

std::string quoted(const std::vector<std::string>& names) {
  constexpr std::size_t most = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i) {
    text += std::string(i == 0 ? "" : ", ") + "\"" + names[i] + "\"";
  }
  if (names.size() > most) text += " and " + std::to_string(names.size() - most) + " more";
  return text;
}

/// The surfaces of the file: physical ones if it has any, else elementary ones.
class Surfaces {
 public:
  explicit Surfaces(const MshFile& file) : _file(file) {
    _physical = std::any_of(file.triangles.begin(), file.triangles.end(),
                            [](const auto& t) { return t.group != 0; });
    for (const auto& t : file.triangles) {
      if (_physical && t.group == 0) {
        refuse("triangle " + std::to_string(t.tag) + " of surface " + std::to_string(t.entity) +
               " is in no physical surface, but others are; put every surface in one");
      }
      _tags.insert(tag_of(t));
    }
  }

  bool physical() const { return _physical; }
  const std::set<std::int32_t>& tags() const { return _tags; }
  std::int32_t tag_of(const MshElement<3>& t) const { return _physical ? t.group : t.entity; }

  std::string name(std::int32_t tag) const {
    const auto named = _file.surface_names.find(tag);
    const bool has_name = _physical && named != _file.surface_names.end() && !named->second.empty();
    return has_name ? printable(named->second) : std::to_string(tag);
  }

 private:
  const MshFile& _file;
  bool _physical = false;
  std::set<std::int32_t> _tags;
};

void check_given(const Surfaces& surfaces, const std::map<std::int32_t, std::string>& given) {
  for (const auto& [tag, name] : given) {
    const std::string field = "options.surface_groups[" + std::to_string(tag) + "]";
    const std::string what = surfaces.physical() ? "surface group" : "surface";
    if (!surfaces.tags().contains(tag)) {
      throw errors::Error(
          errors::Reason::invalid_argument,
          "the file has no " + what + " " + std::to_string(tag) + "; its " + what + "s are " +
              list_of(std::vector<std::int32_t>(surfaces.tags().begin(), surfaces.tags().end())))
          .at(field);
    }
    if (!mesh::valid_name(name)) {
      throw errors::Error(errors::Reason::invalid_argument,
                          what + " " + std::to_string(tag) + " is said to be \"" + printable(name) +
                              "\"; a subdomain's name is " + std::string(mesh::name_rule))
          .at(field);
    }
  }
}

/// Surfaces that the request gives one name are one subdomain; other names must differ.
void take_tags(const MshFile& file, const Surfaces& surfaces,
               const std::map<std::int32_t, std::string>& given, Mesh& mesh) {
  struct Named {
    std::int32_t index = 0;
    std::int32_t tag = 0;
    bool given = false;
  };
  std::map<std::string, Named> by_name;
  std::map<std::int32_t, std::int32_t> index_of;
  for (const std::int32_t tag : surfaces.tags()) {
    const auto said = given.find(tag);
    const bool is_given = said != given.end();
    const std::string name = is_given ? said->second : surfaces.name(tag);
    const auto next = static_cast<std::int32_t>(mesh.subdomains.size());
    const auto [entry, added] = by_name.emplace(name, Named{next, tag, is_given});
    if (added) {
      mesh.subdomains.push_back(name);
    } else if (!is_given || !entry->second.given) {
      refuse("surfaces " + std::to_string(entry->second.tag) + " and " + std::to_string(tag) +
             " have the same name, \"" + name +
             "\"; give each its own, or make them one physical group");
    }
    index_of[tag] = entry->second.index;
  }
  for (const auto& t : file.triangles) mesh.subdomain.push_back(index_of.at(surfaces.tag_of(t)));
}

/// Every piece of the mesh between the cuts is a subdomain, in the order of their first triangles.
void take_pieces(const mesh::EdgeTable& edges,
                 std::span<const std::pair<std::int32_t, std::int32_t>> cuts, Mesh& mesh) {
  mesh::UnionFind pieces(mesh.triangle_count());
  edges.each([&](std::span<const mesh::EdgeUse> uses) {
    const auto key = std::pair(uses[0].low(), uses[0].high());
    if (std::binary_search(cuts.begin(), cuts.end(), key)) return;
    for (std::size_t i = 1; i < uses.size(); ++i) pieces.unite(uses[0].triangle, uses[i].triangle);
  });
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const auto t = static_cast<std::int32_t>(i);
    const std::int32_t first = pieces.find(t);
    if (first == t) {
      mesh.subdomain.push_back(static_cast<std::int32_t>(mesh.subdomains.size()));
      mesh.subdomains.push_back(std::to_string(mesh.subdomains.size() + 1));
    } else {
      mesh.subdomain.push_back(mesh.subdomain[static_cast<std::size_t>(first)]);
    }
  }
  mesh.warnings.push_back("the file has one surface and no physical one: " +
                          (mesh.subdomains.size() == 1
                               ? std::string("it is one subdomain, \"1\"")
                               : "the " + std::to_string(mesh.subdomains.size()) +
                                     " pieces into which its lines cut it are the subdomains " +
                                     quoted(mesh.subdomains)));
}

void take_tension(const std::map<std::string, double>& given, Mesh& mesh) {
  if (given.empty()) return;
  mesh.tension.assign(mesh.subdomains.size(), 1.0);
  for (const auto& [name, value] : given) {
    const std::string field = "options.tension[" + printable(name) + "]";
    const auto found = std::find(mesh.subdomains.begin(), mesh.subdomains.end(), name);
    if (found == mesh.subdomains.end()) {
      throw errors::Error(errors::Reason::invalid_argument,
                          "tension is given for \"" + printable(name) +
                              "\", which is not a subdomain; they are " + quoted(mesh.subdomains))
          .at(field);
    }
    if (!(value > 0) || !std::isfinite(value)) {
      std::ostringstream text;
      text << "the tension of \"" << name << "\" is " << value
           << "; it takes a finite number above 0";
      throw errors::Error(errors::Reason::invalid_argument, text.str()).at(field);
    }
    mesh.tension[static_cast<std::size_t>(found - mesh.subdomains.begin())] = value;
  }
}

}  // namespace

void read_surfaces(const MshFile& file, const mesh::MeshOptions& options,
                   const mesh::EdgeTable& edges,
                   std::span<const std::pair<std::int32_t, std::int32_t>> cuts, Mesh& mesh) {
  const Surfaces surfaces(file);
  check_given(surfaces, options.surface_groups);
  mesh.subdomain.reserve(file.triangles.size());
  const bool single = !surfaces.physical() && surfaces.tags().size() == 1;
  if (single && options.surface_groups.empty()) {
    take_pieces(edges, cuts, mesh);
  } else {
    take_tags(file, surfaces, options.surface_groups, mesh);
    if (!surfaces.physical() && options.surface_groups.size() < surfaces.tags().size()) {
      mesh.warnings.push_back("the file has no physical surface: its surfaces are the subdomains " +
                              quoted(mesh.subdomains));
    }
  }
  take_tension(options.tension, mesh);
}

}  // namespace anticrack::mesher
